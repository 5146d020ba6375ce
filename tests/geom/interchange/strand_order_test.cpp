// SPDX-License-Identifier: Apache-2.0
#include "geom/interchange/strand_order.h"

#include <gtest/gtest.h>

namespace pelage {
namespace {

/// Strands of 1, 2 and 3 points; each number says which strand and which point it belongs to.
StrandArrays numbered_strands() {
  StrandArrays arrays;
  arrays.first_point = {0, 1, 3, 6};
  arrays.root_uv = {{0, 0}, {1, 0}, {2, 0}};
  StrandAttribute constant{"constant", AttributeClass::kConstant, 1, {7}},
      per_strand{"per_strand", AttributeClass::kPerStrand, 2, {}},
      per_point{"per_point", AttributeClass::kPerPoint, 1, {}};
  for (int strand = 0; strand < 3; ++strand) {
    for (int k = 0; k < 2; ++k) per_strand.values.push_back(static_cast<float>(10 * strand + k));
    for (int point = 0; point <= strand; ++point) {
      const auto number = static_cast<float>(10 * strand + point);
      arrays.points.insert(arrays.points.end(), {number, 0, 0, 1});
      per_point.values.push_back(number);
    }
  }
  arrays.attributes = {constant, per_strand, per_point};
  return arrays;
}

TEST(StrandOrder, AllArraysFollowTheIds) {
  StrandArrays arrays = numbered_strands();
  sort_by_id(std::vector<uint64_t>{30, 10, 20}, arrays);
  EXPECT_EQ(arrays.first_point, (std::vector<uint32_t>{0, 2, 5, 6}));
  EXPECT_EQ(arrays.points, (std::vector<float>{10, 0, 0, 1, 11, 0, 0, 1, 20, 0, 0, 1,
                                               21, 0, 0, 1, 22, 0, 0, 1, 0,  0, 0, 1}));
  EXPECT_EQ(arrays.root_uv, (std::vector<V2f>{{1, 0}, {2, 0}, {0, 0}}));
  EXPECT_EQ(arrays.attributes[0].values, (std::vector<float>{7}));
  EXPECT_EQ(arrays.attributes[1].values, (std::vector<float>{10, 11, 20, 21, 0, 1}));
  EXPECT_EQ(arrays.attributes[2].values, (std::vector<float>{10, 11, 20, 21, 22, 0}));
}

TEST(StrandOrder, EqualOrMissingIdsChangeNothing) {
  for (const std::vector<uint64_t>& ids : {std::vector<uint64_t>{3, 1, 3}, {}, {2, 1}}) {
    StrandArrays arrays = numbered_strands();
    sort_by_id(ids, arrays);
    EXPECT_EQ(arrays.first_point, numbered_strands().first_point);
    EXPECT_EQ(arrays.points, numbered_strands().points);
  }
}

}  // namespace
}  // namespace pelage
