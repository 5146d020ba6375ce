// SPDX-License-Identifier: Apache-2.0
#include "why/strand_why.h"

#include <gtest/gtest.h>

namespace pelage {
namespace {

StrandArrays straight(CurveBasis basis, int points) {
  StrandArrays arrays;
  arrays.basis = basis;
  arrays.first_point = {0, static_cast<uint32_t>(points)};
  arrays.ids = {7};
  for (int i = 0; i < points; ++i)
    arrays.points.insert(arrays.points.end(), {3 * static_cast<float>(i), 0, 4 * static_cast<float>(i), 1});
  return arrays;
}

TEST(StrandPlaces, OfAStraightStrand) {
  for (const int points : {2, 5, 6}) {
    const StrandPlaces places = strand_places(Strands(straight(CurveBasis::kPinnedBSpline, points)));
    const float length = 5 * static_cast<float>(points - 1);
    EXPECT_NEAR(places.length, length, 1e-4f * length);
    EXPECT_LT((places.position[0] - V3f(0)).length(), 1e-5f);
    EXPECT_LT((places.position[1] - V3f(0.3f, 0, 0.4f) * length).length(), 1e-4f);
    EXPECT_LT((places.position[2] - V3f(0.6f, 0, 0.8f) * length).length(), 1e-4f);
    for (const float width : places.width) EXPECT_NEAR(width, 2, 1e-5f);
    EXPECT_FALSE(places.color);
  }
}

TEST(StrandPlaces, ColoursAndCorners) {
  StrandArrays arrays = straight(CurveBasis::kLinear, 3);
  arrays.points[8] = 6, arrays.points[10] = -8;  // the last point: back to z = -8
  arrays.attributes.push_back({"color", AttributeClass::kPerPoint, 3, {0, 0, 0, 1, 0, 0, 1, 1, 0}});
  const StrandPlaces places = strand_places(Strands(arrays));
  EXPECT_NEAR(places.length, 5 + std::hypot(3.0f, 12.0f), 1e-4f);
  EXPECT_EQ(places.position[1], V3f(3, 0, 4));
  ASSERT_TRUE(places.color);
  EXPECT_EQ((*places.color)[0], Rgb(0));
  EXPECT_EQ((*places.color)[1], Rgb(1, 0, 0));
  EXPECT_EQ((*places.color)[2], Rgb(1, 1, 0));
}

}  // namespace
}  // namespace pelage
