// SPDX-License-Identifier: Apache-2.0
#include "lab/measure/error_curve.h"

#include <cmath>

#include <gtest/gtest.h>

namespace pelage {
namespace {

TEST(ErrorCurve, IsAStraightLineInLogarithms) {
  // Error 1 / s: with four times the seconds, a quarter of the error.
  const ErrorCurve curve{{1, 1}, {4, 0.25}, {16, 0.0625}};
  for (const double error : {1.0, 0.5, 0.25, 0.1, 0.0625})
    EXPECT_NEAR(cpu_s_to(curve, error), 1 / error, 1e-9);
  EXPECT_NEAR(cpu_s_to({{16, 0.0625}, {1, 1}, {4, 0.25}}, 0.1), 10, 1e-9) << "in any order";
}

TEST(ErrorCurve, HasAnErrorAfterEachTime) {
  const ErrorCurve curve{{16, 0.0625}, {1, 1}, {4, 0.25}};
  for (const double cpu_s : {1.0, 2.0, 4.0, 10.0, 16.0})
    EXPECT_NEAR(error_after(curve, cpu_s), 1 / cpu_s, 1e-9);
  EXPECT_TRUE(std::isnan(error_after(curve, 0.9)));
  EXPECT_TRUE(std::isnan(error_after(curve, 17)));
  EXPECT_TRUE(std::isnan(error_after({{1, 0.1}}, 1)));
}

TEST(ErrorCurve, IsNotExtrapolated) {
  EXPECT_TRUE(std::isnan(cpu_s_to({}, 0.1)));
  EXPECT_TRUE(std::isnan(cpu_s_to({{1, 0.1}}, 0.1)));
  EXPECT_TRUE(std::isnan(cpu_s_to({{1, 1}, {4, 0.25}}, 0.2)));
  EXPECT_TRUE(std::isnan(cpu_s_to({{1, 1}, {4, 0.25}}, 1.1)));
  EXPECT_TRUE(std::isnan(cpu_s_to({{1, 0.1}, {4, 0.2}}, 0.15))) << "the error grows";
}

TEST(ErrorCurve, LeavesOutPointsWithoutAnError) {
  EXPECT_NEAR(cpu_s_to({{1, 1}, {2, NAN}, {3, -0.01}, {NAN, 0.3}, {4, 0.25}}, 0.5), 2, 1e-9);
}

}  // namespace
}  // namespace pelage
