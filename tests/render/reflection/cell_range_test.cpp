// SPDX-License-Identifier: Apache-2.0
#include "render/reflection/cell_range.h"

#include <vector>

#include <gtest/gtest.h>

#include "base/hash.h"

namespace pelage {
namespace {

CellPath cells_in(uint64_t largest) { return {mix64(largest + 1), mix64(largest + 2), largest}; }

TEST(CellRange, OneOfTheRangesHasEachCell) {
  for (const uint64_t parts : {1, 3, 8}) {
    int halved = 0;
    std::vector<int> times(1000, 0);
    double last = 0;
    for (CellRange range(CellRange::kAll / parts); !range.is_over(); range.advance()) {
      if (++halved % 3 == 2 && range.can_halve()) range.halve();
      EXPECT_GT(range.share_done(), last);
      last = range.share_done();
      for (uint64_t i = 0; i < times.size(); ++i) times[i] += range.contains(cells_in(mix64(i))) ? 1 : 0;
    }
    EXPECT_EQ(last, 1);
    EXPECT_GE(static_cast<uint64_t>(halved), parts);
    for (const int count : times) EXPECT_EQ(count, 1);
  }
}

TEST(CellRange, AllHasTheFirstAndTheLastKey) {
  const CellRange all;
  EXPECT_TRUE(all.is_all());
  EXPECT_TRUE(all.contains(cells_in(0)) && all.contains(cells_in(~uint64_t{0})));
  EXPECT_FALSE(CellRange(CellRange::kAll / 2).is_all());
  EXPECT_FALSE(CellRange(1).can_halve());
}

}  // namespace
}  // namespace pelage
