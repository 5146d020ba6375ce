// SPDX-License-Identifier: Apache-2.0
#include "render/reflection/reflection_table.h"

#include <map>
#include <vector>

#include <gtest/gtest.h>

#include "base/hash.h"

namespace pelage {
namespace {

/// Paths with weights that floats add exactly, in any order.
void add_path(ReflectionTable& table, uint64_t i, uint64_t cells) {
  const uint64_t key[] = {mix64(mix64(i) % cells)};
  const float weight = 1 + static_cast<float>(i % 3);
  const Rgb light[] = {Rgb(static_cast<float>(i % 7)), Rgb(0, 1, static_cast<float>(i % 5))};
  table.add(key, weight, light);
}

TEST(ReflectionTable, FindsTheWeightedMeansOfItsCells) {
  constexpr uint64_t kPaths = 3000, kCells = 400;
  struct Sum {
    float weight = 0, light = 0;
    uint32_t paths = 0;
  };
  std::map<uint64_t, Sum> expected;
  ReflectionTable table(2);
  EXPECT_EQ(table.find(5), 0u);
  for (uint64_t i = 0; i < kPaths; ++i) {
    add_path(table, i, kCells);
    Sum& sum = expected[mix64(mix64(i) % kCells)];
    sum.weight += 1 + static_cast<float>(i % 3);
    sum.light += (1 + static_cast<float>(i % 3)) * static_cast<float>(i % 7);
    ++sum.paths;
  }
  table.finish(8);
  EXPECT_EQ(table.size(), expected.size());
  for (const auto& [key, sum] : expected) {
    const size_t cell = table.find(key);
    ASSERT_LT(cell, table.size());
    EXPECT_EQ(table.cell(cell).paths, sum.paths);
    EXPECT_FLOAT_EQ(table.radiance(cell)[0].x, sum.light / sum.weight);
    EXPECT_FLOAT_EQ(table.radiance(cell)[1].y, 1);
    EXPECT_EQ(table.radiance(cell)[1].x, 0);
  }
  EXPECT_EQ(table.find(mix64(kCells + 1)), table.size());
  EXPECT_LE(table.bytes(), ReflectionTable::max_bytes(table.size(), 2));
}

TEST(ReflectionTable, ASumOfTablesIsTheTableOfAllPaths) {
  ReflectionTable whole(2), sum(2);
  for (uint64_t part = 0; part < 5; ++part) {
    ReflectionTable table(2);
    for (uint64_t i = 0; i < 100; ++i) {
      add_path(whole, 100 * part + i, 60);
      add_path(table, 100 * part + i, 60);
    }
    sum.add(table);
  }
  ASSERT_EQ(sum.size(), whole.size());
  for (size_t i = 0; i < whole.size(); ++i) {
    EXPECT_EQ(sum.cell(i).key, whole.cell(i).key);
    EXPECT_EQ(sum.cell(i).paths, whole.cell(i).paths);
    EXPECT_EQ(sum.cell(i).weight, whole.cell(i).weight);
    for (int light = 0; light < 2; ++light) EXPECT_EQ(sum.radiance(i)[light], whole.radiance(i)[light]);
  }
}

TEST(ReflectionTable, SmallCellsBorrowPathsOfTheCellsAroundThem) {
  ReflectionTable table(1);
  const uint64_t left[] = {1, 10, 100}, right[] = {2, 10, 100}, far[] = {3, 30, 100};
  const auto add = [&](const uint64_t(&cells)[3], float weight, float value) {
    const Rgb light[] = {Rgb(value)};
    table.add(cells, weight, light);
  };
  add(left, 2, 1);
  add(left, 2, 5);
  add(right, 2, 9);
  add(far, 4, 6);
  table.finish(1);
  const auto mean = [&](uint64_t key) { return table.radiance(table.find(key))[0].x; };
  const float all = (2 * 1 + 2 * 5 + 2 * 9 + 4 * 6) / 10.0f;  // of the largest cell: by weight
  const float near = (2 * (1 + 5 + 9) + 2 * all) / 8;         // 3 paths of weight 2, and one more
  EXPECT_FLOAT_EQ(mean(100), all);
  EXPECT_FLOAT_EQ(mean(10), near);
  EXPECT_FLOAT_EQ(mean(1), (2 * (1 + 5) + 2 * near) / 6);
  EXPECT_FLOAT_EQ(mean(2), (2 * 9 + 2 * near) / 4);
  EXPECT_FLOAT_EQ(mean(3), (4 * 6 + 4 * ((4 * 6 + 4 * all) / 8)) / 8);
}

TEST(ReflectionTable, WithoutSmallCellsTheOthersStayAsTheyWere) {
  const auto add = [](ReflectionTable& table, uint64_t i) {
    const uint64_t cells[] = {mix64(i % 50), mix64(1000 + i % 10), mix64(2000 + i % 5)};
    const Rgb light[] = {Rgb(static_cast<float>(i % 7)), Rgb(1)};
    table.add(cells, 1 + static_cast<float>(i % 3), light);
  };
  ReflectionTable whole(2), before(2), within(2), part(2);
  for (uint64_t i = 0; i < 600; ++i) {
    add(whole, i);
    if (i == 200) within.drop_smallest();
    add(i < 300 ? before : part, i);
    add(within, i);
  }
  before.drop_smallest();
  before.add(part);
  ASSERT_EQ(whole.size(), 65u);
  for (const ReflectionTable* table : {&before, &within}) {
    ASSERT_EQ(table->size(), 15u);
    for (size_t i = 0; i < table->size(); ++i) {
      const size_t same = whole.find(table->cell(i).key);
      ASSERT_LT(same, whole.size());
      EXPECT_EQ(table->find(table->cell(i).key), i);
      EXPECT_EQ(table->cell(i).weight, whole.cell(same).weight);
      EXPECT_EQ(table->radiance(i)[0], whole.radiance(same)[0]);
    }
    EXPECT_EQ(table->find(mix64(0)), table->size());
  }
  for (int i = 0; i < 2; ++i) before.drop_smallest();
  EXPECT_EQ(before.size(), 0u);
  EXPECT_EQ(before.find(mix64(2000)), 0u);
  add(before, 7);
  EXPECT_EQ(before.size(), 0u);
}

TEST(ReflectionTable, ACellWithoutWeightReflectsNothing) {
  ReflectionTable table(1);
  const Rgb light[] = {Rgb(3)};
  const uint64_t key[] = {9};
  table.add(key, 0, light);
  table.finish(4);
  EXPECT_EQ(table.radiance(table.find(9))[0], Rgb(0));
}

}  // namespace
}  // namespace pelage
