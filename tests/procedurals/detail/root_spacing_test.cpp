// SPDX-License-Identifier: Apache-2.0
#include "procedurals/detail/root_spacing.h"

#include <cmath>

#include <gtest/gtest.h>

#include "base/parallel.h"
#include "tests/procedurals/square_groom.h"

namespace pelage {
namespace {

TEST(RootSpacing, OfRandomRootsIsTheRootOfTheAreaPerRoot) {
  MemoryLedger ledger;
  const Workers workers(2);
  for (const uint32_t count : {400, 6400}) {
    const float spacing = root_spacing(*grown_on_a_square(ledger, count, 8000), workers);
    // The areas of the discs of 32 roots vary by 1 / sqrt(8) each; roots near the edge have larger discs.
    const double expected = std::sqrt(4.0 / count);
    EXPECT_GT(spacing, 0.85 * expected);
    EXPECT_LT(spacing, 1.3 * expected);
  }
}

TEST(RootSpacing, DoesNotDependOnLeaves) {
  MemoryLedger ledger;
  const Workers workers(2);
  const float whole = root_spacing(*grown_on_a_square(ledger, 1000, 8000), workers);
  EXPECT_EQ(root_spacing(*grown_on_a_square(ledger, 1000, 100), workers), whole);
  EXPECT_EQ(root_spacing(*grown_on_a_square(ledger, 1000, 13), workers), whole);
}

TEST(RootSpacing, OfAFewRootsIsUnknown) {
  MemoryLedger ledger;
  EXPECT_EQ(root_spacing(*grown_on_a_square(ledger, 8, 8000), Workers(1)), 0);
  EXPECT_GT(root_spacing(*grown_on_a_square(ledger, 9, 8000), Workers(1)), 0);
}

}  // namespace
}  // namespace pelage
