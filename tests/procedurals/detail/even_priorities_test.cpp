// SPDX-License-Identifier: Apache-2.0
#include "procedurals/detail/even_priorities.h"

#include <algorithm>
#include <array>
#include <map>

#include <gtest/gtest.h>

#include "base/error.h"
#include "tests/procedurals/square_groom.h"

namespace pelage {
namespace {

std::map<uint64_t, float> by_id(const Groom& groom, MemoryLedger& ledger) {
  const EvenPriorities priorities(groom, ledger);
  std::map<uint64_t, float> result;
  for (size_t f = 0; f < priorities.size(); ++f) result[groom.follicles().id(f)] = priorities[f];
  return result;
}

TEST(EvenPriorities, EveryPartOfTheSkinKeepsTheSameFraction) {
  MemoryLedger ledger;
  const auto groom = grown_on_a_square(ledger, 5000, 8000);
  const EvenPriorities priorities(*groom, ledger);
  Box3f box;
  const PosedSkin rest;
  for (size_t f = 0; f < priorities.size(); ++f) box.extendBy(groom->root(f, rest, 0).position);
  const float longest = std::max(box.size().x, box.size().y);
  constexpr int kCells = 8;
  for (const float fraction : {0.5f, 0.25f, 0.125f}) {
    std::array<int, kCells * kCells> all{}, kept{};
    for (size_t f = 0; f < priorities.size(); ++f) {
      const V3f at = (groom->root(f, rest, 0).position - box.min) * (1 / longest);
      const int x = std::min(static_cast<int>(kCells * at.x), kCells - 1);
      const int y = std::min(static_cast<int>(kCells * at.y), kCells - 1);
      ++all[static_cast<size_t>(kCells * y + x)];
      kept[static_cast<size_t>(kCells * y + x)] += priorities[f] < fraction;
    }
    // The curve passes a cell at once. Roots on a border may be rounded to either side.
    for (size_t cell = 0; cell < all.size(); ++cell) {
      EXPECT_NEAR(kept[cell], fraction * static_cast<float>(all[cell]), 2) << fraction << " " << cell;
    }
  }
}

TEST(EvenPriorities, AreUniformAndDoNotDependOnLeaves) {
  MemoryLedger ledger;
  const auto whole = by_id(*grown_on_a_square(ledger, 1000, 8000), ledger);
  EXPECT_EQ(whole, by_id(*grown_on_a_square(ledger, 1000, 17), ledger));
  std::vector<float> sorted;
  for (const auto& [id, priority] : whole) sorted.push_back(priority);
  std::sort(sorted.begin(), sorted.end());
  // 1,000 ranks are a prefix of 1,024.
  for (size_t i = 0; i < sorted.size(); ++i) EXPECT_NEAR(sorted[i], static_cast<double>(i) / 1000, 0.025);
  EXPECT_EQ(std::adjacent_find(sorted.begin(), sorted.end()), sorted.end());
}

TEST(EvenPriorities, ChargeWhatTheyHoldOrAreRefused) {
  MemoryLedger ledger;
  const auto groom = grown_on_a_square(ledger, 1000, 8000);
  const int64_t before = ledger.current(MemoryTag::kGrooms);
  {
    const EvenPriorities priorities(*groom, ledger);
    EXPECT_EQ(ledger.current(MemoryTag::kGrooms), before + 4000);
  }
  EXPECT_EQ(ledger.current(MemoryTag::kGrooms), before);
  ledger.set_limit(static_cast<uint64_t>(ledger.budgeted()) + 15000);
  EXPECT_THROW(EvenPriorities(*groom, ledger), Error);
}

}  // namespace
}  // namespace pelage
