// SPDX-License-Identifier: Apache-2.0
#include "geom/rest_position.h"

#include <gtest/gtest.h>

namespace pelage {
namespace {

/// Two strands of 4 and 5 points with one attribute.
Strands two_strands(StrandAttribute attribute) {
  StrandArrays a;
  a.first_point = {0, 4, 9};
  a.points.assign(size_t(9) * 4, 0.5f);
  a.ids = {7, 9};
  a.attributes.push_back(std::move(attribute));
  return Strands(std::move(a));
}

TEST(RestPosition, IsAnAttributeOfAnyClass) {
  const auto second = [](AttributeClass frequency, std::vector<float> values) {
    return rest_position(two_strands({"Pref", frequency, 3, std::move(values)}), 1);
  };
  EXPECT_EQ(second(AttributeClass::kPerStrand, {1, 2, 3, 4, 5, 6}), V3f(4, 5, 6));
  EXPECT_EQ(second(AttributeClass::kConstant, {7, 8, 9}), V3f(7, 8, 9));
  std::vector<float> points(27);
  points[3 * 4] = 2;  // the root of the second strand
  EXPECT_EQ(second(AttributeClass::kPerPoint, points), V3f(2, 0, 0));
}

TEST(RestPosition, OtherAttributesAreNone) {
  EXPECT_FALSE(rest_position(two_strands({"Pref", AttributeClass::kPerStrand, 1, {1, 2}}), 0));
  EXPECT_FALSE(rest_position(two_strands({"P", AttributeClass::kConstant, 3, {1, 2, 3}}), 0));
}

}  // namespace
}  // namespace pelage
