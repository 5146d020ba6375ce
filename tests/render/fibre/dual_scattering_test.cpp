// SPDX-License-Identifier: Apache-2.0
#include "render/fibre/dual_scattering.h"

#include <cmath>
#include <limits>

#include <gtest/gtest.h>

#include "base/job.h"
#include "base/parallel.h"
#include "base/progress.h"
#include "tests/render/sphere_statistics.h"

namespace pelage::dual_scattering_test {
namespace {

constexpr float kNone = std::numeric_limits<float>::infinity();

MaterialParams prepared(MaterialParams params) {
  MemoryLedger ledger;
  NoProgress progress;
  return with_tables(std::move(params), {Workers::alone(), ledger, progress});
}

/// The same series summed by adding one layer of fibres after the other below the first.
float backscatter_of_layers(float forward, float backward) {
  double stack = 0;
  for (int layer = 0; layer < 200'000; ++layer) {
    const double next = backward + forward * double{forward} * stack / (1 - backward * stack);
    if (std::abs(next - stack) < 1e-12) break;
    stack = next;
  }
  return static_cast<float>(forward * double{forward} * stack / (1 - backward * stack));
}

TEST(DualScattering, SumsUpAllReflectionsOfAStack) {
  for (const auto& [forward, backward] :
       {std::pair(0.6f, 0.3f), {0.8f, 0.1f}, {0.2f, 0.05f}, {0.7f, 0.29f}, {0.5f, 0.0f}})
    EXPECT_NEAR(stack_backscatter(forward, backward), backscatter_of_layers(forward, backward), 1e-4f);
  // The first two terms [Zinke08, equations 11 and 13], where a_b is so small that the others do not matter.
  const float f2 = 0.5f * 0.5f, b = 0.02f;
  const float first = b * f2 / (1 - f2), second = b * b * b * f2 / std::pow(1 - f2, 3.0f);
  EXPECT_NEAR(stack_backscatter(0.5f, b), first + second, 1e-6f);
  EXPECT_EQ(stack_backscatter(0.5f, 0), 0);
}

TEST(DualScattering, AveragesOfASmoothCylinder) {
  // Figures of an exact integral over a dielectric cylinder of index 1.55 seen at a right angle, by its
  // absorption per radius. The model has a little roughness and the table interpolates between angles.
  ChiangParams params;
  params.eta = 1.55f;
  params.beta_m = params.beta_n = 0.1f;
  params.alpha = 0;
  const struct {
    float absorption, forward, backward;
  } cases[] = {{0, 0.790f, 0.210f}, {0.2f, 0.553f, 0.146f}, {1, 0.154f, 0.058f}};
  for (const auto& expected : cases) {
    params.absorption = Rgb(expected.absorption);
    const FibreAverages fibre = FibreAverageTable(FibreMaterial(params)).at(0, Rgb(0.5f));
    EXPECT_NEAR(fibre.forward.x, expected.forward, 0.02f);
    EXPECT_NEAR(fibre.backward.y, expected.backward, 0.02f);
    EXPECT_NEAR(fibre.forward_shift, 0, 0.02f);
  }
}

TEST(DualScattering, BothFractionsAreTheAlbedoUnderEveryModel) {
  const MaterialParams models[] = {ConeShellParams(), LambertCylinderParams(),
                                   KajiyaKayParams(), ChiangParams(),
                                   DeonParams(),      YanFastParams()};
  for (const MaterialParams& model : models) {
    const FibreMaterial material(prepared(model));
    const FibreAverageTable table(material);
    for (const float sine : {-0.6f, 0.0f, 0.6f}) {
      const Rgb color(0.6f, 0.3f, 0.1f);
      Rgb albedo(0);
      constexpr int kPlaces = 64;
      for (int i = 0; i < kPlaces; ++i) {
        FibrePoint point;
        point.tangents.fill(V3f(1, 0, 0));
        point.wo = V3f(sine, std::sqrt(1 - sine * sine), 0);
        point.h = (2 * static_cast<float>(i) + 1) / kPlaces - 1;
        point.color = color;
        albedo += material.at(point).albedo() / kPlaces;
      }
      const FibreAverages fibre = table.at(sine, color);
      // The table has 9 colours and 12 angles, of 512 samples each.
      for (int c = 0; c < 3; ++c)
        EXPECT_NEAR(fibre.forward[c] + fibre.backward[c], albedo[c], 0.03f) << model.index();
    }
  }
}

class DualFibreLight : public testing::Test {
 protected:
  /// Light scattered to a viewer from all directions, of which none is absorbed by the fibres themselves.
  Rgb scattered(float sine, float strands, float through, const Rgb& color) const {
    const V3f wo(sine, std::sqrt(1 - sine * sine), 0);
    const DualScattering dual(table_, V3f(1, 0, 0), wo, color);
    Rgb sum(0);
    constexpr int kSteps = 64;
    for (int i = 0; i < kSteps; ++i) {
      const float z = (2 * static_cast<float>(i) + 1) / kSteps - 1, across = std::sqrt(1 - z * z);
      for (int k = 0; k < kSteps; ++k) {
        const float phi = 2 * kPi * (static_cast<float>(k) + 0.5f) / kSteps;
        const V3f wi(z, across * std::cos(phi), across * std::sin(phi));
        sum += dual.arriving(wi).eval({}, strands, through).total() * (4 * kPi / (kSteps * kSteps));
      }
    }
    return sum;
  }
  static ChiangParams white() {
    ChiangParams params;
    params.absorption = Rgb(0);
    return params;
  }
  FibreAverageTable table_{FibreMaterial(white())};
};

TEST_F(DualFibreLight, NeverExceedsWhatArrives) {
  for (const float sine : {-0.8f, 0.0f, 0.5f}) {
    for (const float strands : {1.0f, 4.0f, 20.0f}) {
      const float light = scattered(sine, strands, 0, Rgb(1)).x;
      // A white fibre scatters everything, and its surroundings once more at most.
      EXPECT_LE(light, 2 * 1.02f);
      EXPECT_GT(light, 0);
    }
  }
}

TEST_F(DualFibreLight, FadesWithTheStrandsBetween) {
  EXPECT_GT(scattered(0, 1, 0, Rgb(1)).x, scattered(0, 3, 0, Rgb(1)).x);
  EXPECT_EQ(scattered(0, kNone, 0, Rgb(1)).x, 0);
  const DualScattering dual(table_, V3f(1, 0, 0), V3f(0, 1, 0), Rgb(1));
  FibreValue direct;
  direct[LobeGroup::kPrimary] = Rgb(2);
  EXPECT_EQ(dual.arriving(V3f(0, 0, 1)).eval(direct, kNone, 0)[LobeGroup::kPrimary], Rgb(0));
  EXPECT_EQ(dual.arriving(V3f(0, 0, 1)).eval(direct, 0, 1)[LobeGroup::kPrimary], Rgb(2));
  EXPECT_GT(dual.arriving(V3f(0, 0, 1)).max_strands(), 5);
}

TEST(DualScattering, IsGuessedWellEnoughToChooseAmongLights) {
  // If the guess was far too low, a chosen light would count far too much. Its lobes are wider than the
  // tilted ones of eval(): by up to a factor of 5 for the narrowest lobes here.
  for (const float roughness : {0.05f, 0.3f, 0.6f}) {
    ChiangParams params;
    params.beta_m = params.beta_n = roughness;
    const FibreAverageTable table{FibreMaterial(params)};
    const DualScattering dual(table, V3f(1, 0, 0), V3f(0.3f, std::sqrt(1 - 0.09f), 0), Rgb(0.5f));
    for (float sine = -0.95f; sine < 1; sine += 0.05f) {
      for (const float phi : {0.1f, 1.5f, 3.0f}) {
        const float cosine = std::sqrt(1 - sine * sine);
        const V3f wi(sine, cosine * std::cos(phi), cosine * std::sin(phi));
        const float exact = luminance(dual.arriving(wi).eval({}, 1, 0).total());
        EXPECT_GT(10 * luminance(dual.likely(wi)), exact - 1e-3f) << roughness << ' ' << sine << ' ' << phi;
      }
    }
  }
}

TEST(DualScattering, MaxStrandsLeaveThreePerCentOfTheLightOfEachDirection) {
  ChiangParams params;
  params.absorption = Rgb(0.02f);
  const FibreAverageTable table{FibreMaterial(params)};
  const Rgb color(0.5f);
  const DualScattering dual(table, V3f(1, 0, 0), V3f(0, 1, 0), color);
  for (const float sine : {-0.9f, -0.3f, 0.0f, 0.6f, 0.95f}) {
    const float strands = dual.arriving(V3f(sine, std::sqrt(1 - sine * sine), 0)).max_strands();
    const float left = max_component(table.at(sine, color).forward);
    if (strands < 64) {
      EXPECT_LE(std::pow(left, strands), 0.03f) << sine;
    }
    if (strands > 1) {
      EXPECT_GT(std::pow(left, strands - 1), 0.03f) << sine;
    }
  }
}

TEST(DualScattering, BlackFibresBlockAtOnce) {
  ChiangParams black;
  black.absorption = Rgb(50);
  const FibreAverageTable table{FibreMaterial(black)};
  const DualScattering dual(table, V3f(1, 0, 0), V3f(0, 1, 0), Rgb(0));
  EXPECT_LE(dual.arriving(V3f(0, 0, 1)).max_strands(), 3);
}

}  // namespace
}  // namespace pelage::dual_scattering_test
