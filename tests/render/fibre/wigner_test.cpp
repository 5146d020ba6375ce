// SPDX-License-Identifier: Apache-2.0
#include "render/fibre/wigner.h"

#include <gtest/gtest.h>

#include "tests/render/random.h"
#include "tests/support/chi_square.h"

namespace pelage {
namespace {

TEST(Wigner, DrawsTheReferenceNumbers) {
  const WignerTable& table = WignerTable::instance();
  // By quadrature in double precision.
  const std::pair<float, double> reference[] = {{0.01f, -0.9343329934}, {0.05f, -0.8053836365},
                                                {0.1f, -0.6870488261},  {0.25f, -0.4039727533},
                                                {0.4f, -0.1577361938},  {0.5f, 0.0}};
  for (const auto& [xi, u] : reference) {
    EXPECT_NEAR(table.sample(xi), u, 4e-7) << xi;
    EXPECT_NEAR(table.sample(1.0f - xi), -u, 4e-7) << xi;
  }
}

TEST(Wigner, TableInvertsTheDistribution) {
  const WignerTable& table = WignerTable::instance();
  double worst = 0, worst_slope = 0;
  float before = -1.0f;
  for (int i = 0; i < 200000; ++i) {
    const float xi = (i + 0.5f) / 200000;
    const float u = table.sample(xi);
    ASSERT_GT(u, before) << xi;
    before = u;
    worst = std::max(worst, std::abs(wigner_cdf(u) - xi));
  }
  EXPECT_LT(worst, 3e-7);
  // What the table really has as its density, by difference quotients away from rounding, is the analytic
  // one.
  for (int i = 1; i < 499; ++i) {
    const float a = i / 500.0f, b = (i + 1) / 500.0f;
    const double density = (b - a) / (static_cast<double>(table.sample(b)) - table.sample(a));
    double mean = 0;
    for (int k = 0; k < 100; ++k) {
      mean += 1 / wigner_pdf(table.sample(a + (b - a) * (k + 0.5f) / 100)) / 100;
    }
    worst_slope = std::max(worst_slope, std::abs(density * mean - 1));
  }
  EXPECT_LT(worst_slope, 1e-3);
}

TEST(Wigner, EndsAreSafe) {
  const WignerTable& table = WignerTable::instance();
  for (float xi : {0.0f, 0x1p-30f, 0x1p-24f, 1.0f - 0x1p-24f}) {
    const float u = table.sample(xi);
    EXPECT_LT(std::abs(u), 1.0f) << xi;
    EXPECT_GT(wigner_pdf(u), 0.0f) << xi;
  }
  // u + 1 = (3 pi xi / (4 sqrt 2))^(2/3) near the end.
  for (float xi : {0x1p-24f, 0x1p-20f, 0x1p-16f}) {
    EXPECT_NEAR(
        (table.sample(xi) + 1.0f) / std::pow(3 * std::numbers::pi * xi / (4 * std::sqrt(2.0)), 2.0 / 3.0),
        1.0, 2e-2)
        << xi;
  }
  EXPECT_EQ(wigner_pdf(1.0f), 0.0f);
  EXPECT_EQ(wigner_pdf(-1.0f), 0.0f);
}

template <class Sample, class Cdf>
ChiSquare line_chi_square(Sample&& sample, Cdf&& cdf) {
  constexpr int kCells = 400, kSamples = 400000;
  std::vector<double> observed(kCells, 0.0), expected(kCells);
  TestRandom random(31);
  for (int i = 0; i < kSamples; ++i) {
    observed[std::min(static_cast<int>((sample(random.unit()) + 1) / 2 * kCells), kCells - 1)] += 1;
  }
  for (int i = 0; i < kCells; ++i) {
    expected[i] = kSamples * (cdf(-1 + 2.0 * (i + 1) / kCells) - cdf(-1 + 2.0 * i / kCells));
  }
  return chi_square(observed, expected);
}

TEST(Wigner, PassesChiSquare) {
  const ChiSquare test = line_chi_square([](float xi) { return WignerTable::instance().sample(xi); },
                                         [](double u) { return wigner_cdf(u); });
  EXPECT_GT(test.p, 1e-4);
  EXPECT_EQ(test.impossible, 0);
}

TEST(Wigner, TentPassesChiSquareAndIntegratesToOne) {
  const auto cdf = [](double u) {
    const double v = 1 - std::abs(u);
    const double tail = (1 - kTentFloor) * v * v / 2 + kTentFloor * v / 2;
    return u < 0 ? tail : 1 - tail;
  };
  EXPECT_NEAR(cdf(1.0), 1.0, 1e-12);
  EXPECT_GT(line_chi_square([](float xi) { return tent_sample(xi); }, cdf).p, 1e-4);
  double integral = 0;
  for (int i = 0; i < 10000; ++i) integral += tent_pdf(-1 + (i + 0.5f) / 5000) / 5000;
  EXPECT_NEAR(integral, 1.0, 1e-6);
  for (int i = 0; i < 1000; ++i) EXPECT_NEAR(cdf(tent_sample(i / 1000.0f)), i / 1000.0, 1e-6);
}

/// Relative variance of weight / pdf over the densities: Var / mean^2, by quadrature.
template <class Pdf>
double relative_variance(Pdf&& pdf) {
  double mean = 0, square = 0;
  constexpr int kSteps = 400000;
  for (int i = 0; i < kSteps; ++i) {
    const double u = -1 + 2 * (i + 0.5) / kSteps;
    const double weight = std::sqrt(1 - u * u);
    mean += weight * 2 / kSteps;
    square += weight * weight / pdf(static_cast<float>(u)) * 2 / kSteps;
  }
  return square / (mean * mean) - 1;
}

TEST(Wigner, OrdersTheSamplersAsTheNoteDoes) {
  EXPECT_NEAR(relative_variance([](float) { return 0.5; }), 0.0808, 5e-5);
  EXPECT_NEAR(relative_variance([](float u) { return tent_pdf(u); }), 0.0160, 5e-5);
  EXPECT_NEAR(relative_variance([](float u) { return wigner_pdf(u); }), 0.0, 1e-5);
}

}  // namespace
}  // namespace pelage
