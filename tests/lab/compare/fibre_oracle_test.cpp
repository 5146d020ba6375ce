// SPDX-License-Identifier: Apache-2.0 Compares every model with light traced by brute force through the fibre
// that the model approximates: energy, and the distributions around and along the fibre. Known errors of
// published models are expected here, with their reasons.
#include "lab/compare/fibre_oracle.h"

#include <gtest/gtest.h>

#include "render/fibre/medulla_tables.h"

namespace pelage {
namespace {

constexpr int kPaths = 40000;
/// Random difference of two histograms with this many paths.
constexpr double kChance = 0.025;

struct Distances {
  double energy;  ///< of the model over that of the traced light
  double around, along;
};
Distances distances(const FibreOracle& oracle, float theta) {
  const FibreHistogram model = oracle.model(theta, kPaths), traced = oracle.trace(theta, kPaths);
  return {model.total() / traced.total(), total_variation(model.by_azimuth(), traced.by_azimuth()),
          total_variation(model.by_sine(), traced.by_sine())};
}

template <class P>
P small_tables(P params) {
  if constexpr (requires { params.made; }) {
    params.made = MedullaTables::make(params.optics(), Workers(2), 2000);
  }
  return params;
}

constexpr float kAbsorptions[] = {0.0f, 0.2f, 1.0f};
constexpr float kInclinations[] = {0.0f, 0.6f, -1.1f};

/// Near field of clear fibres, smooth ones included: attenuations are those of one straight leg, which is
/// what happens; and all longer ways leave evenly all around, which is a simplification of less than a
/// hundredth of the light at normal incidence and two at grazing.
TEST(FibreOracle, ChiangIsWhatIsTraced) {
  for (float roughness : {0.1f, 0.3f}) {
    ChiangParams params;
    params.beta_m = params.beta_n = roughness;
    for (float absorption : kAbsorptions) {
      for (float theta : kInclinations) {
        const Distances d = distances(fibre_oracle(params, absorption), theta);
        EXPECT_NEAR(d.energy, 1, 0.02) << absorption << ' ' << theta;
        EXPECT_LT(d.around, kChance + 0.05) << roughness << ' ' << absorption << ' ' << theta;
        EXPECT_LT(d.along, kChance + 0.02) << roughness << ' ' << absorption << ' ' << theta;
      }
    }
  }
}

TEST(FibreOracle, DeonIsWhatIsTraced) {
  for (float width : {3.0f, 12.0f}) {
    DeonParams params;
    params.beta = width;
    params.azimuthal_width = width;
    for (float absorption : kAbsorptions) {
      for (float theta : kInclinations) {
        const Distances d = distances(fibre_oracle(params, absorption), theta);
        EXPECT_NEAR(d.energy, 1, 0.02) << absorption << ' ' << theta;
        EXPECT_LT(d.around, kChance + 0.025) << width << ' ' << absorption << ' ' << theta;
        EXPECT_LT(d.along, kChance + 0.02) << width << ' ' << absorption << ' ' << theta;
      }
    }
  }
}

/// Expected failure: the published model scatters nearly twice the light that arrives, because a Gaussian of
/// unit area in theta_h has area 2 in theta_i. The distribution around the fibre is correct. The distribution
/// of the halved and of the conserving model along the fibre is correct too; the halved one loses light at
/// the flanks of the Gaussian and in the longer paths that the model omits.
TEST(FibreOracle, MarschnerIsTwiceWhatIsTraced) {
  for (MarschnerVariant variant :
       {MarschnerVariant::kPublished, MarschnerVariant::kHalved, MarschnerVariant::kConserving}) {
    MarschnerParams params;
    params.variant = variant;
    params.beta = 5;
    for (float absorption : kAbsorptions) {
      for (float theta : {0.0f, 0.6f}) {
        const Distances d = distances(fibre_oracle(params, absorption), theta);
        const double twice = variant == MarschnerVariant::kPublished ? 2 : 1;
        EXPECT_NEAR(d.energy / twice, 1, 0.04) << absorption << ' ' << theta;
        EXPECT_LT(d.around, kChance + 0.03) << absorption << ' ' << theta;
        EXPECT_LT(d.along, kChance + 0.04) << absorption << ' ' << theta;
      }
    }
  }
}

/// Fibres with a medulla. The analytic lobe of yan-fast is a fit to a few hundredths of what is scattered;
/// the tables are as good as their cells, twelve to each of inclination and h.
///
/// Expected failure: with absorption, what is scattered is off around the fibre by up to 0.07. The models of
/// [Yan15] and [Yan17] absorb scattered light as much whichever way it leaves, but what leaves ahead has not
/// travelled as far as what leaves behind.
TEST(FibreOracle, YanIsWhatIsTraced) {
  for (YanPreset preset : {YanPreset::kNone, YanPreset::kRowA, YanPreset::kRowC}) {
    YanParams table;
    table.preset = preset;
    table = small_tables(table);
    YanFastParams fast;
    fast.preset = preset;
    for (float absorption : {0.0f, 0.3f}) {
      for (float theta : {0.0f, -1.1f}) {
        const Distances a = distances(fibre_oracle(table, absorption), theta),
                        b = distances(fibre_oracle(fast, absorption), theta);
        EXPECT_NEAR(a.energy, 1, 0.03) << static_cast<int>(preset) << ' ' << absorption << ' ' << theta;
        EXPECT_NEAR(b.energy, 1, 0.05) << static_cast<int>(preset) << ' ' << absorption << ' ' << theta;
        EXPECT_LT(a.around, kChance + (absorption > 0 ? 0.07 : 0.03))
            << static_cast<int>(preset) << ' ' << absorption << ' ' << theta;
        EXPECT_LT(a.along, kChance + 0.05) << static_cast<int>(preset) << ' ' << absorption << ' ' << theta;
        EXPECT_LT(b.around, kChance + 0.08) << static_cast<int>(preset) << ' ' << absorption << ' ' << theta;
        EXPECT_LT(b.along, kChance + 0.12) << static_cast<int>(preset) << ' ' << absorption << ' ' << theta;
      }
    }
  }
}

/// Expected failure: opaque models send nothing, or as much as backward, through the fibre; a clear fibre
/// sends most of its light there. That is what the word non-translucent means.
TEST(FibreOracle, OpaqueModelsLackTheLightThatGoesThrough) {
  const auto forward = [](const FibreHistogram& histogram) {
    const std::vector<double> around = histogram.by_azimuth();
    double sum = 0;
    for (int i = 0; i < FibreHistogram::kAzimuths; ++i) {
      const bool behind = i < FibreHistogram::kAzimuths / 4 || i >= 3 * FibreHistogram::kAzimuths / 4;
      if (behind) sum += around[static_cast<size_t>(i)];
    }
    return sum / histogram.total();
  };
  for (const MaterialParams& params :
       {MaterialParams(LambertCylinderParams{}), MaterialParams(KajiyaKayParams{}),
        MaterialParams(ConeShellParams{})}) {
    const FibreOracle oracle = fibre_oracle(params, 0.2f);
    EXPECT_TRUE(oracle.opaque);
    const FibreHistogram model = oracle.model(0, kPaths), traced = oracle.trace(0, kPaths);
    EXPECT_NEAR(model.total(), traced.total(), 0.02);
    EXPECT_GT(forward(traced), 0.75);
    EXPECT_LT(forward(model), 0.52);
  }
}

TEST(FibreOracle, TotalVariation) {
  EXPECT_EQ(total_variation({1, 2, 3}, {2, 4, 6}), 0);
  EXPECT_EQ(total_variation({1, 0}, {0, 5}), 1);
  EXPECT_DOUBLE_EQ(total_variation({1, 1}, {3, 1}), 0.25);
  EXPECT_EQ(total_variation({0, 0}, {1, 1}), 1);
}

TEST(FibreOracle, ModelsTakeTheLooksOfOthers) {
  ChiangParams chiang;
  chiang.color = Field(Rgb(0.1f, 0.2f, 0.3f));
  chiang.opacity = Field(0.5f);
  chiang.beta_m = 0.7f;
  ASSERT_EQ(fibre_model_names().size(), 8u);
  for (const std::string& name : fibre_model_names()) {
    const MaterialParams params = with_fibre_model(chiang, name);
    EXPECT_EQ(fibre_params(params)->color.color({}), Rgb(0.1f, 0.2f, 0.3f)) << name;
    EXPECT_EQ(fibre_params(params)->opacity.value({}), 0.5f) << name;
  }
  EXPECT_EQ(std::get<ChiangParams>(with_fibre_model(chiang, "chiang")).beta_m, 0.7f);
}

}  // namespace
}  // namespace pelage
