// SPDX-License-Identifier: Apache-2.0
#include <optional>

#include <gtest/gtest.h>

#include "cache/residency.h"
#include "tests/cache/test_grower.h"

namespace pelage {
namespace {

constexpr size_t kWords = 1000;
constexpr size_t kBytes = kWords * sizeof(uint64_t);

TEST(ResidencyMove, UnitsMoveToAnotherResidency) {
  MemoryLedger ledger;
  TestGrower grower = TestGrower::of_equal_units(10, kWords);
  std::optional<Residency> residency;
  const auto make = [&] {  // room for three units
    const uint64_t limit = Residency::index_bytes(10, 1) + 3 * kBytes;
    residency.emplace(grower, 10, 1, MemoryBudget{limit}, ledger, MemoryTag::kChunks);
  };
  const auto visit = [&](uint32_t slot) {
    return residency->visit(slot, 0, [&](Resident& unit) { return is_whole(unit, slot); });
  };
  make();
  const int64_t empty = ledger.budgeted();
  visit(2);
  visit(5);
  const int64_t grown = grower.grown();
  EXPECT_EQ(residency->release(7), nullptr);
  std::unique_ptr<Resident> unit = residency->release(5);
  ASSERT_NE(unit, nullptr);
  EXPECT_TRUE(is_whole(*unit, 5));
  EXPECT_FALSE(residency->is_resident(5));
  EXPECT_EQ(ledger.budgeted(), empty + int64_t(kBytes));
  std::unique_ptr<Resident> other = residency->release(2);
  EXPECT_EQ(ledger.budgeted(), empty);
  residency.reset();

  make();
  residency->adopt(5, std::move(unit), kBytes);
  EXPECT_EQ(ledger.budgeted(), empty + int64_t(kBytes));
  EXPECT_TRUE(visit(5));
  EXPECT_EQ(grower.grown(), grown) << "it need not grow";
  for (const uint32_t slot : {1u, 2u, 3u, 4u, 6u}) EXPECT_TRUE(visit(slot));
  EXPECT_FALSE(residency->is_resident(5)) << "it is evicted like any other";
  EXPECT_TRUE(visit(5));
  EXPECT_GE(residency->counts().reexpansions, 1);
  EXPECT_LE(ledger.budgeted(), empty + int64_t(3 * kBytes));
}

}  // namespace
}  // namespace pelage
