// SPDX-License-Identifier: Apache-2.0
#include "lab/measure/line_fit.h"

#include <cmath>
#include <utility>
#include <vector>

#include <gtest/gtest.h>

#include "base/hash.h"

namespace pelage {
namespace {

using Points = std::vector<std::pair<double, double>>;

TEST(LineFit, GoesThroughPointsOfALine) {
  const LineFit fit = fit_line(Points{{0, 5}, {10, 25}, {20, 45}, {40, 85}});
  EXPECT_NEAR(fit.slope, 2, 1e-12);
  EXPECT_NEAR(fit.at(1000), 2005, 1e-9);
  EXPECT_NEAR(fit.residual, 0, 1e-12);
  EXPECT_NEAR(fit.error_at(1000), 0, 1e-9);
  EXPECT_EQ(fit_line(Points{{1, 2}, {3, 6}}).residual, 0);
}

TEST(LineFit, HasAnswersOnlyWhereThereIsALine) {
  EXPECT_TRUE(std::isnan(fit_line(Points{{1, 2}}).at(3)));
  EXPECT_TRUE(std::isnan(fit_line(Points{{1, 2}, {1, 3}}).slope));
  EXPECT_TRUE(std::isnan(fit_line(Points{}).at_zero));
  EXPECT_TRUE(std::isnan(fit_line(Points{{0, 1}, {1, NAN}}).at(2)));
}

// Many lines through points that are off by the same: what is extrapolated scatters as it is said to.
TEST(LineFit, KnowsItsError) {
  const double at = 100, noise = 3;
  const int lines = 4000;
  double squares = 0, stated = 0;
  for (uint64_t line = 0; line < lines; ++line) {
    Points points;
    for (uint64_t i = 0; i < 6; ++i) {
      double sum = 0;  // normal enough: of variance 1
      for (uint64_t n = 0; n < 12; ++n) sum += unit_float(hash64(line, i, n)) - 0.5;
      points.emplace_back(10.0 * static_cast<double>(i),
                          7 + 0.5 * 10.0 * static_cast<double>(i) + noise * sum);
    }
    const LineFit fit = fit_line(points);
    squares += (fit.at(at) - 57) * (fit.at(at) - 57) / lines;
    stated += fit.error_at(at) * fit.error_at(at) / lines;
  }
  EXPECT_NEAR(stated / squares, 1, 0.08);
}

}  // namespace
}  // namespace pelage
