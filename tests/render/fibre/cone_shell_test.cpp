// SPDX-License-Identifier: Apache-2.0
#include "render/fibre/cone_shell.h"

#include <gtest/gtest.h>

#include "tests/render/random.h"
#include "tests/support/chi_square.h"

namespace pelage {
namespace {

constexpr double kPiD = std::numbers::pi;
constexpr float kDegrees = 180 / kPi;

/// The shell about the cone of polar angle `mid`, radians.
ConeShell shell_at(float mid, float half_width, ShellVariant variant) {
  return ConeShell(ShellShape(half_width * kDegrees, 0), variant, -std::cos(mid));
}

TEST(ConeShell, LiteralNormalisationIsThatOfTheNote) {
  const struct {
    float mid, half_width;
    double norm;
  } reference[] = {{1.0f, 0.2f, 2.08687401},
                   {1.3f, 0.6f, 6.45391112},
                   {0.3f, 0.6f, 2.22508901},  // cut at the pole
                   {kPi / 2, kPi / 2, kPiD * kPiD},
                   {kPi - 0.3f, 0.6f, 2.22508901}};
  for (const auto& r : reference) {
    EXPECT_NEAR(1 / shell_at(r.mid, r.half_width, ShellVariant::kLiteral).density(std::cos(r.mid)) / r.norm,
                1, 2e-6)
        << r.mid << " " << r.half_width;
  }
}

TEST(ConeShell, LiteralIsReciprocalUntilCut) {
  // f = rho / cos(theta_i) at theta_o = .3, theta_i = -.2 and the other way around.
  const auto f = [](float theta_o, float theta_i, float width) {
    const ConeShell shell(ShellShape(width * kDegrees, 0), ShellVariant::kLiteral, std::sin(theta_o));
    return shell.density(std::sin(theta_i)) / std::cos(theta_i);
  };
  EXPECT_NEAR(f(0.3f, -0.2f, 0.4f), 0.22293362, 5e-7);
  EXPECT_NEAR(f(-0.2f, 0.3f, 0.4f), 0.22293362, 5e-7);
  TestRandom random(4);
  int compared = 0;
  for (int i = 0; i < 2000; ++i) {
    const float width = random.between(0.05f, 1.2f);
    const float limit = kPi / 2 - width - 0.01f;
    const float a = random.between(-limit, limit), b = random.between(-limit, limit);
    if (std::abs(std::abs(a + b) - width) < 1e-5f) continue;
    EXPECT_NEAR(f(a, b, width), f(b, a, width), 1e-5 * f(a, b, width));
    compared += f(a, b, width) > 0;
  }
  EXPECT_GT(compared, 300);
}

/// The price of a sampler that is exact: weights across a shell are those of sin(theta_i), not of theta_i.
TEST(ConeShell, WignerIsReciprocalOnlyWhereItIsNarrow) {
  const auto off = [](float width) {
    const auto f = [&](float theta_o, float theta_i) {
      const ConeShell shell(ShellShape(width * kDegrees, 0), ShellVariant::kWigner, std::sin(theta_o));
      return shell.density(std::sin(theta_i)) / std::cos(theta_i);
    };
    return std::abs(f(0.8f, -0.8f + 0.5f * width) / f(-0.8f + 0.5f * width, 0.8f) - 1);
  };
  EXPECT_GT(off(0.4f), 0.1f);
  EXPECT_NEAR(off(0.02f) / 0.02f, 0.5f * std::tan(0.8f), 0.02f);
}

TEST(ConeShell, LiteralDrawsTheReferenceNumbers) {
  const ConeShell shell = shell_at(1.1f, 0.4f, ShellVariant::kLiteral);
  const struct {
    float xi;
    double psi, density;
  } reference[] = {
      {0.1f, -0.29474259, 0.22523711}, {0.5f, 0.03823837, 0.23521568}, {0.9f, 0.32720526, 0.22289908}};
  for (const auto& r : reference) {
    EXPECT_NEAR(std::acos(shell.sample(r.xi)) - 1.1, r.psi, 1e-6);
    EXPECT_NEAR(shell.density(shell.sample(r.xi)), r.density, 1e-6);
  }
}

struct ShellCase {
  float theta_o, width_degrees, tilt_degrees;
  ShellVariant variant;
  ConeShell shell() const {
    return ConeShell(ShellShape(width_degrees, tilt_degrees), variant, std::sin(theta_o));
  }
};

std::vector<ShellCase> shell_grid() {
  std::vector<ShellCase> grid;
  for (ShellVariant variant : {ShellVariant::kWigner, ShellVariant::kLiteral}) {
    for (float theta : {0.0f, 0.4f, -1.1f, 1.4f, -1.55f, kPi / 2}) {
      for (float width : {1.0f, 12.0f, 45.0f, 90.0f}) {
        for (float tilt : {0.0f, -7.0f, 45.0f}) grid.push_back({theta, width, tilt, variant});
      }
    }
  }
  return grid;
}

std::ostream& operator<<(std::ostream& out, const ShellCase& c) {
  return out << "theta_o " << c.theta_o << " width " << c.width_degrees << " tilt " << c.tilt_degrees
             << (c.variant == ShellVariant::kWigner ? " wigner" : " literal");
}

/// Integral over the sphere of `f(z) density(z)`.
template <class Function>
double shell_integral(const ConeShell& shell, Function&& f) {
  // z as a cosine: the substitution takes the square roots out of the ends.
  constexpr int kSteps = 4000;
  const double low = shell.z_min(), high = shell.z_max();
  double sum = 0;
  for (int i = 0; i < kSteps; ++i) {
    const double angle = kPiD * (i + 0.5) / kSteps;
    const double z = 0.5 * (low + high) - 0.5 * (high - low) * std::cos(angle);
    sum += f(z) * shell.density(static_cast<float>(z)) * 0.5 * (high - low) * std::sin(angle) * kPiD / kSteps;
  }
  return 2 * kPiD * sum;
}

TEST(ConeShell, EveryShellIntegratesToOne) {
  for (const ShellCase& c : shell_grid()) {
    const ConeShell shell = c.shell();
    // At the poles a float z resolves a shell of one degree to a part in a thousand.
    const double resolution = 2e-4 + 1.2e-7 / (shell.z_max() - shell.z_min());
    EXPECT_NEAR(shell_integral(shell, [](double) { return 1; }), 1, resolution) << c;
  }
}

TEST(ConeShell, EverySamplerPassesChiSquare) {
  const std::vector<ShellCase> grid = shell_grid();
  constexpr ShellSampler kSamplers[] = {ShellSampler::kMatched, ShellSampler::kUniform, ShellSampler::kTent};
  const double level = sidak_level(1e-3, 3.0 * grid.size());
  uint64_t seed = 0;
  for (const ShellCase& c : grid) {
    const ConeShell shell = c.shell();
    const double low = shell.z_min(), range = shell.z_max() - low;
    if (range < 0.01) continue;  // too few floats for cells
    for (ShellSampler sampler : kSamplers) {
      constexpr int kCells = 50, kSamples = 40000, kSteps = 40;
      std::vector<double> observed(kCells, 0.0), expected(kCells, 0.0);
      TestRandom random(++seed);
      for (int i = 0; i < kSamples; ++i) {
        const double z = shell.sample(sampler, random.unit()).z;
        observed[std::clamp(static_cast<int>((z - low) / range * kCells), 0, kCells - 1)] += 1;
      }
      for (int i = 0; i < kCells * kSteps; ++i) {
        const double place = (i + 0.5) / (kCells * kSteps);
        const float z = static_cast<float>(low + range * place);
        const double density = sampler == ShellSampler::kMatched   ? 2 * kPiD * shell.density(z)
                               : sampler == ShellSampler::kUniform ? 1 / range
                                                                   : tent_pdf(2 * place - 1) * 2 / range;
        expected[i / kSteps] += kSamples * density * range / (kCells * kSteps);
      }
      EXPECT_GT(chi_square(observed, expected).p, level) << c << " sampler " << static_cast<int>(sampler);
    }
  }
}

TEST(ConeShell, SamplersAgreeOnIntegrals) {
  const ShellCase cases[] = {{0.4f, 12, 0, ShellVariant::kWigner},
                             {0.4f, 30, 0, ShellVariant::kLiteral},
                             {-1.4f, 45, 5, ShellVariant::kWigner},
                             {1.4f, 45, -5, ShellVariant::kLiteral}};
  const double level = sidak_level(1e-3, 3 * 2 * std::size(cases));
  for (const ShellCase& c : cases) {
    const ConeShell shell = c.shell();
    for (int function = 0; function < 2; ++function) {
      const auto f = [&](double z) { return function == 0 ? z * z : std::exp(z); };
      const double truth = shell_integral(shell, f);
      for (ShellSampler sampler : {ShellSampler::kMatched, ShellSampler::kUniform, ShellSampler::kTent}) {
        RunningMean mean;
        TestRandom random(91 + static_cast<int>(sampler));
        for (int i = 0; i < 100000; ++i) {
          const ShellPoint point = shell.sample(sampler, random.unit());
          mean.add(f(point.z) * 2 * kPiD * shell.density(point.z) / point.pdf);
        }
        EXPECT_GT(normal_tail((mean.mean() - truth) / mean.standard_error()), level)
            << c << ": " << mean.mean() << " for " << truth;
      }
    }
  }
}

/// Relative variance of the literal weight over a density in z, cones about the equator.
template <class Pdf>
double literal_variance(double half_width, Pdf&& pdf) {
  const double range = std::sin(half_width);
  double mean = 0, square = 0;
  constexpr int kSteps = 200000;
  for (int i = 0; i < kSteps; ++i) {
    const double u = -std::cos(kPiD * (i + 0.5) / kSteps);
    const double du = std::sqrt(1 - u * u) * kPiD / kSteps;
    const double weight = std::sqrt(1 - range * range * u * u);
    mean += weight * du;
    square += weight * weight / pdf(u) * du;
  }
  return square / (mean * mean) - 1;
}

TEST(ConeShell, NarrowLiteralShellsAreNotBestSampledByTheSemicircle) {
  const struct {
    double half_width, uniform, wigner;
  } reference[] = {{0.1, 0.00000, 0.23165},
                   {0.3, 0.00019, 0.21543},
                   {0.6, 0.00295, 0.16378},
                   {1.0, 0.02259, 0.06669},
                   {kPiD / 2, 0.08076, 0}};
  for (const auto& r : reference) {
    EXPECT_NEAR(literal_variance(r.half_width, [](double) { return 0.5; }), r.uniform, 1e-5) << r.half_width;
    EXPECT_NEAR(literal_variance(r.half_width, [](double u) { return 2 / kPiD * std::sqrt(1 - u * u); }),
                r.wigner, 1e-5)
        << r.half_width;
  }
}

TEST(ConeShell, TheWholeSphereIsTheDiffuseLaw) {
  for (ShellVariant variant : {ShellVariant::kWigner, ShellVariant::kLiteral}) {
    const ConeShell shell(ShellShape(90, 0), variant, 0);
    for (float theta = -1.5f; theta < 1.5f; theta += 0.1f) {
      EXPECT_NEAR(shell.density(std::sin(theta)), std::cos(theta) / (kPiD * kPiD), 1e-6);
    }
  }
}

TEST(ConeShell, IsCentredOnTheMirroredInclination) {
  for (float theta_o : {-0.9f, -0.3f, 0.0f, 0.5f, 1.0f}) {
    const ConeShell shell(ShellShape(10, 0), ShellVariant::kWigner, std::sin(theta_o));
    const float width = 10 / kDegrees;
    EXPECT_GT(shell.density(std::sin(-theta_o)),
              0.95f * shell.density(0.5f * (shell.z_min() + shell.z_max())));
    EXPECT_EQ(shell.density(std::sin(-theta_o + 1.01f * width)), 0);
    EXPECT_EQ(shell.density(std::sin(-theta_o - 1.01f * width)), 0);
    EXPECT_GT(shell.density(std::sin(-theta_o + 0.99f * width)), 0);
    // A tilt turns the lobe to the root: to smaller inclinations.
    const ConeShell tilted(ShellShape(10, 5), ShellVariant::kWigner, std::sin(theta_o));
    EXPECT_EQ(tilted.density(std::sin(-theta_o + 0.99f * width)), 0);
    EXPECT_GT(tilted.density(std::sin(-theta_o - 1.01f * width)), 0);
  }
}

}  // namespace
}  // namespace pelage
