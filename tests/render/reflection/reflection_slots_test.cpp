// SPDX-License-Identifier: Apache-2.0
#include "render/reflection/reflection_slots.h"

#include <cmath>
#include <limits>
#include <vector>

#include <gtest/gtest.h>

#include "base/hash.h"

namespace pelage::reflection_slots_test {
namespace {

constexpr uint64_t kCells = 3000;

Rgb light_of(uint64_t cell, size_t light) {
  const auto value = static_cast<float>(cell) + 0.25f * static_cast<float>(light);
  return {value, 2 * value, 1 / (1 + value)};
}

/// Cells without larger ones; each has (1 + cell % 12) paths of the same radiance.
ReflectionTable table_of(size_t lights) {
  ReflectionTable table(lights);
  std::vector<Rgb> radiance(lights);
  for (uint64_t cell = 0; cell < kCells; ++cell) {
    for (size_t light = 0; light < lights; ++light) radiance[light] = light_of(cell, light);
    const uint64_t key[] = {mix64(cell + 1)};
    for (uint64_t path = 0; path < 1 + cell % 12; ++path) table.add(key, 1, radiance);
  }
  table.finish(8);
  return table;
}

ReflectionSlots slots_of(const ReflectionTable& table, size_t lights, uint32_t fewest) {
  ReflectionSlots slots(lights, table.size());
  slots.add(table, fewest);
  return slots;
}

TEST(ReflectionSlots, HaveTheCellsOfTheTable) {
  for (const size_t lights : {1, 2, 3, 5, 30}) {
    const ReflectionTable table = table_of(lights);
    const ReflectionSlots slots = slots_of(table, lights, 1);
    EXPECT_EQ(slots.size(), kCells);
    EXPECT_EQ(slots.bytes(), ReflectionSlots::bytes(kCells, lights));
    for (uint64_t cell = 0; cell < kCells; ++cell) {
      const auto found = slots.find(mix64(cell + 1), 0);
      ASSERT_TRUE(found) << cell;
      const Rgb* expected = table.radiance(table.find(mix64(cell + 1)));
      for (size_t light = 0; light < lights; ++light)
        EXPECT_EQ(found[light], PackedRadiance::unpack(PackedRadiance::pack(expected[light]))) << cell;
    }
    for (uint64_t cell = kCells; cell < 2 * kCells; ++cell) EXPECT_FALSE(slots.find(mix64(cell + 1), 0));
  }
}

TEST(ReflectionSlots, LeaveOutCellsWhoseLargestHasFewPaths) {
  const ReflectionSlots slots = slots_of(table_of(2), 2, 8);
  for (uint64_t cell = 0; cell < kCells; ++cell)
    EXPECT_EQ(static_cast<bool>(slots.find(mix64(cell + 1), 0)), 1 + cell % 12 >= 8) << cell;
  ReflectionTable nested(1);
  const Rgb light[] = {Rgb(1)};
  const uint64_t left[] = {mix64(1), mix64(10)}, right[] = {mix64(2), mix64(10)},
                 far[] = {mix64(3), mix64(30)};
  for (int i = 0; i < 4; ++i) nested.add(left, 1, light);
  for (int i = 0; i < 4; ++i) nested.add(right, 1, light);
  for (int i = 0; i < 7; ++i) nested.add(far, 1, light);
  nested.finish(8);
  const ReflectionSlots of = slots_of(nested, 1, 8);
  EXPECT_EQ(of.size(), 3u);
  EXPECT_TRUE(of.find(mix64(1), 0) && of.find(mix64(2), 0) && of.find(mix64(10), 1));
  EXPECT_FALSE(of.find(mix64(3), 0) || of.find(mix64(30), 1));
}

TEST(ReflectionSlots, KeysThatStartInTheLastSlotGoOnInTheFirst) {
  ReflectionTable table(1);
  for (uint64_t i = 0; i < 8; ++i) {
    const uint64_t key[] = {~uint64_t{0} - 4 * i};
    const Rgb light[] = {Rgb(static_cast<float>(i))};
    table.add(key, 1, light);
  }
  table.finish(8);
  const ReflectionSlots slots = slots_of(table, 1, 1);
  for (uint64_t i = 0; i < 8; ++i) {
    ASSERT_TRUE(slots.find(~uint64_t{0} - 4 * i, 0));
    EXPECT_EQ(slots.find(~uint64_t{0} - 4 * i, 0)[0], Rgb(static_cast<float>(i)));
  }
  EXPECT_FALSE(slots.find(~uint64_t{0} - 32, 0));
}

/// Cells of one slice each, on three levels.
TEST(ReflectionSlots, ADroppedLevelLeavesTheOthersAndMakesRoom) {
  constexpr uint64_t kSlices = 40, kFew = 25;
  ReflectionSlots slots(1, 2 * kSlices * kFew, ReflectionSlots::Density::kSmall);
  const auto key = [](uint64_t cell, uint64_t level) { return mix64(3 * cell + level + 1); };
  const auto add = [&](uint64_t slice, uint32_t smallest) {
    ReflectionTable table(1, 0, smallest);
    for (uint64_t i = slice * kFew; i < (slice + 1) * kFew; ++i) {
      const uint64_t cells[] = {key(i, 0), key(i, 1), key(i, 2)};
      const Rgb light[] = {light_of(i, 0)};
      table.add(cells, 1, light);
    }
    table.finish(8);
    slots.add(table, 1);
  };
  for (uint64_t slice = 0; slice < kSlices / 2; ++slice) add(slice, 0);
  slots.drop(0);
  EXPECT_EQ(slots.size(), kSlices * kFew);
  for (uint64_t slice = kSlices / 2; slice < kSlices; ++slice) add(slice, 1);
  EXPECT_EQ(slots.size(), 2 * kSlices * kFew) << "all of the room";
  for (uint64_t i = 0; i < kSlices * kFew; ++i) {
    EXPECT_FALSE(slots.find(key(i, 0), 0));
    for (uint32_t level = 1; level < 3; ++level) {
      ASSERT_TRUE(slots.find(key(i, level), level));
      EXPECT_NEAR(slots.find(key(i, level), level)[0].x, light_of(i, 0).x, 1e-4 * light_of(i, 0).x);
    }
  }
}

TEST(ReflectionSlots, AnEmptyTableHasNoCells) {
  const ReflectionSlots slots = slots_of(ReflectionTable(3), 3, 8);
  EXPECT_EQ(slots.size(), 0u);
  EXPECT_FALSE(slots.find(mix64(1), 0));
}

TEST(PackedRadiance, KeepsEachChannelInAnyUnit) {
  double sum = 0;
  constexpr int kCount = 20000;
  for (int i = 0; i < kCount; ++i) {
    Rgb radiance;
    for (int c = 0; c < 3; ++c) {
      const uint64_t random = hash64(uint64_t(i), uint64_t(c));
      radiance[c] = std::ldexp(1 + unit_float(random), static_cast<int>(random % 250) - 125);
    }
    const Rgb kept = PackedRadiance::unpack(PackedRadiance::pack(radiance));
    for (int c = 0; c < 3; ++c) {
      const double error = double{kept[c]} / radiance[c] - 1;
      ASSERT_LE(std::abs(error), 0x1p-14);
      sum += error;
    }
  }
  EXPECT_LT(std::abs(sum / (3 * kCount)), 0x1p-14 * 4 / std::sqrt(3.0 * kCount)) << "not one-sided";
}

TEST(PackedRadiance, StaysFiniteAndNotNegative) {
  const auto kept = [](float value) {
    return PackedRadiance::unpack(PackedRadiance::pack(Rgb(1, value, 2)));
  };
  EXPECT_EQ(kept(0), Rgb(1, 0, 2));
  EXPECT_EQ(kept(-3), Rgb(1, 0, 2));
  EXPECT_EQ(kept(std::nanf("")), Rgb(1, 0, 2));
  EXPECT_TRUE(std::isfinite(kept(std::numeric_limits<float>::max()).y));
  EXPECT_TRUE(std::isfinite(kept(std::numeric_limits<float>::infinity()).y));
}

}  // namespace
}  // namespace pelage::reflection_slots_test
