// SPDX-License-Identifier: Apache-2.0
#include "render/fibre/yan.h"

#include <gtest/gtest.h>

#include "render/fibre/fibre_tracer.h"
#include "tests/render/fibre/fibre_models.h"

namespace pelage {
namespace {

struct Fibre {
  const char* name;
  float kappa, sigma_ms, g, eta, layers;

  template <class P>
  P params(const Rgb& sigma_ca, const Rgb& sigma_ma) const {
    P p;
    p.kappa = kappa;
    p.sigma_ms = sigma_ms;
    p.g = g;
    p.eta = eta;
    p.layers = layers;
    p.sigma_ca = sigma_ca;
    p.sigma_ma = sigma_ma;
    return p;
  }
  TracedFibre traced() const { return {eta, layers, kappa, sigma_ms, g}; }
};
constexpr Fibre kFibres[] = {{"A", 0.86f, 3.15f, 0.79f, 1.49f, 0.68f},
                             {"C", 0.88f, 1.69f, 0.44f, 1.55f, 0.47f},
                             {"thick", 0.8f, 2, 0.4f, 1.55f, 0.5f},
                             {"thin", 0.5f, 1, 0, 1.55f, 0.5f}};

/// Share of the light by way without absorption: published lobes leave a part out, these sum to 1.
TEST(Yan, EnergyOfEveryWayIsThatOfTracedLight) {
  for (const Fibre& fibre : kFibres) {
    const YanOptics optics = fibre.params<YanFastParams>(Rgb(0), Rgb(0)).optics();
    for (float theta : {0.0f, 0.8f}) {
      for (float h : {0.1f, -0.6f, 0.95f}) {
        constexpr int kPaths = 20000;
        int straight[4] = {}, scattered = 0;
        for (int i = 0; i < kPaths; ++i) {
          const FibrePath path = trace_fibre(fibre.traced(), std::sin(theta), h, 8, i);
          if (path.scattered) {
            ++scattered;
          } else {
            ++straight[std::min(path.entered ? 1 + path.reflections : 0, 3)];
          }
        }
        const MedullaCrossing c(optics, std::sin(theta), std::cos(theta), h);
        const auto a = attenuations(c.surface.reflectance, Rgb(c.unscattered));
        const auto agree = [&](double model, int count) {
          const double traced = count / double(kPaths);
          EXPECT_NEAR(model, traced, 1e-4 + 4.5 * std::sqrt(model * (1 - model) / kPaths))
              << fibre.name << ' ' << theta << ' ' << h;
        };
        for (int p = 0; p < kFibreLobes; ++p) agree(a[p].x, straight[p]);
        agree(c.scattered(), scattered);
        EXPECT_NEAR(a[0].x + a[1].x + a[2].x + a[3].x + c.scattered(), 1, 1e-5);
      }
    }
  }
}

/// What is left of the light by absorption, averaged over h, against light traced through the fibre.
TEST(Yan, AlbedoIsThatOfTracedLight) {
  const Rgb sigma_ca(0.05f, 0.3f, 1.2f), sigma_ma(0.02f, 0.15f, 0.6f);
  for (const Fibre& fibre : kFibres) {
    const auto fast_params = fibre.params<YanFastParams>(sigma_ca, sigma_ma);
    auto full_params = fibre.params<YanParams>(sigma_ca, sigma_ma);
    full_params.made = MedullaTables::make(full_params.optics(), Workers(2), 2000);
    const YanFastMaterial fast(fast_params);
    const YanMaterial full(full_params);
    for (float theta : {0.0f, 0.7f, 1.2f}) {
      constexpr int kPaths = 20000, kOffsets = 200;
      Rgb traced(0), by_fast(0), by_full(0);
      for (int i = 0; i < kPaths; ++i) {
        const float h = 2 * (static_cast<float>(i) + 0.5f) / kPaths - 1;
        const FibrePath path = trace_fibre(fibre.traced(), std::sin(theta), h, 9, i);
        for (int c = 0; c < 3; ++c)
          traced[c] += std::exp(-sigma_ca[c] * path.cortex - sigma_ma[c] * path.core) / kPaths;
      }
      for (int i = 0; i < kOffsets; ++i) {
        const float h = 2 * (static_cast<float>(i) + 0.5f) / kOffsets - 1;
        const FibrePoint point = fibre_point_at(theta, h);
        const FibreFrame frame(point.tangents[0], point.wo);
        by_fast += fast.at(frame, h, Rgb(1)).albedo() / kOffsets;
        by_full += full.at(frame, h, Rgb(1)).albedo() / kOffsets;
      }
      for (int c = 0; c < 3; ++c) {
        EXPECT_NEAR(by_fast[c], traced[c], 0.02) << fibre.name << " fast " << theta << " channel " << c;
        EXPECT_NEAR(by_full[c], traced[c], 0.012) << fibre.name << " full " << theta << " channel " << c;
      }
    }
  }
}

/// Inclination and azimuth of scattered light. The analytic lobe is good to a few hundredths of it per
/// tenth; tables are as good as their cells.
TEST(Yan, ScatteredLightGoesWhereTracedLightGoes) {
  constexpr int kBins = 10;
  for (const Fibre& fibre : kFibres) {
    auto params = fibre.params<YanParams>(Rgb(0), Rgb(0));
    params.made = MedullaTables::make(params.optics(), Workers(2), 2000);
    for (float theta : {0.0f, -0.7f}) {
      constexpr int kPaths = 40000;
      std::array<double, kBins> sine{}, azimuth{}, table_sine{}, table_azimuth{};
      double traced = 0, drawn = 0;
      TestRandom random(12);
      for (int i = 0; i < kPaths; ++i) {
        const float h = 2 * (static_cast<float>(i) + 0.5f) / kPaths - 1;
        const auto bin = [](float x) { return std::clamp(static_cast<int>(x * kBins), 0, kBins - 1); };
        const FibrePath path = trace_fibre(fibre.traced(), std::sin(theta), h, 10, i);
        if (path.scattered) {
          ++traced;
          ++sine[bin(0.5f * (path.wi.x + 1))];
          ++azimuth[bin(0.5f + std::atan2(path.wi.z, path.wi.y) / (2 * kPi))];
        }
        const MedullaCrossing c(params.optics(), std::sin(theta), std::cos(theta), h);
        const SampledAngles a = TabulatedScatter(*params.made, std::sin(theta), h).sample(random.unit3());
        drawn += c.scattered();
        table_sine[bin(0.5f * (a.sin_theta + 1))] += c.scattered();
        table_azimuth[bin(0.5f + wrapped_angle(a.phi) / (2 * kPi))] += c.scattered();
      }
      for (int b = 0; b < kBins; ++b) {
        EXPECT_NEAR(table_sine[b] / drawn, sine[b] / traced, 0.012) << fibre.name << ' ' << theta << ' ' << b;
        EXPECT_NEAR(table_azimuth[b] / drawn, azimuth[b] / traced, 0.012) << fibre.name << ' ' << theta;
        const double from = -1 + 2.0 * b / kBins, to = from + 2.0 / kBins;
        EXPECT_NEAR(wigner_cdf(to) - wigner_cdf(from), sine[b] / traced, 0.035) << fibre.name << ' ' << theta;
      }
    }
  }
}

TEST(Yan, PresetsAreChangedByWhatIsGiven) {
  YanFastParams params;
  params.preset = YanPreset::kRowC;
  EXPECT_EQ(params.optics().kappa, 0.88f);
  EXPECT_EQ(params.optics().sigma_ca, Rgb(0.64f));
  params.kappa = 0.5f;
  params.sigma_ca = Rgb(1, 2, 3);
  EXPECT_EQ(params.optics().kappa, 0.5f);
  EXPECT_EQ(params.optics().sigma_ca, Rgb(1, 2, 3));
  EXPECT_EQ(params.optics().g, 0.44f);
  EXPECT_FALSE(YanFastParams{}.optics().sigma_ca.has_value());
}

}  // namespace
}  // namespace pelage
