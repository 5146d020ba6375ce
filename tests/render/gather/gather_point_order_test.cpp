// SPDX-License-Identifier: Apache-2.0
#include "render/gather/gather_point_order.h"

#include <algorithm>
#include <numeric>

#include <gtest/gtest.h>

#include "base/hash.h"

namespace pelage {
namespace {

TEST(GatherPointOrder, SortsLikeAStableSort) {
  GatherPointOrder order;
  for (const size_t count : {0u, 1u, 7u, 1000u}) {
    const size_t first = 5, groups = 13;
    const auto group = [](size_t item) { return hash64(item, 3) % 13; };
    order.sort(first, count, groups, group);
    std::vector<uint32_t> expected(count);
    std::iota(expected.begin(), expected.end(), static_cast<uint32_t>(first));
    std::stable_sort(expected.begin(), expected.end(),
                     [&](uint32_t a, uint32_t b) { return group(a) < group(b); });
    EXPECT_TRUE(std::ranges::equal(order.items(), expected)) << count;
    size_t begin = 0;
    for (size_t g = 0; g < groups; ++g) {
      const std::span<const uint32_t> items = order.groups(g, 1);
      EXPECT_EQ(items.data(), order.items().data() + begin);
      for (const uint32_t item : items) EXPECT_EQ(group(item), g);
      begin += items.size();
    }
    EXPECT_EQ(begin, count);
    EXPECT_EQ(order.groups(2, 3).size(),
              order.groups(2, 1).size() + order.groups(3, 1).size() + order.groups(4, 1).size());
  }
}

}  // namespace
}  // namespace pelage
