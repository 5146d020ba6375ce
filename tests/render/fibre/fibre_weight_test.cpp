// SPDX-License-Identifier: Apache-2.0
// What one sample of the lobes may weigh: weights multiply along a path, and large ones are fireflies.
#include <algorithm>
#include <vector>

#include <gtest/gtest.h>

#include "render/fibre/tangle.h"
#include "tests/render/fibre/fibre_models.h"

namespace pelage {
namespace {

struct Weights {
  float largest = 0;
  double mean = 0;
};

/// rho / pdf of directions sampled for one way of looking at a fibre, in its most weighted channel.
Weights weights_at(const FibreMaterial& material, const FibrePoint& point, int samples, uint64_t seed) {
  const FibreBsdf bsdf = material.at(point);
  TestRandom random(seed);
  Weights weights;
  for (int i = 0; i < samples; ++i) {
    const std::optional<FibreSample> s = bsdf.sample(random.unit3());
    if (!s) continue;
    const Rgb w = s->value.total() / s->value.pdf;
    weights.largest = std::max({weights.largest, w.x, w.y, w.z});
    weights.mean += (w.x + w.y + w.z) / (3.0 * samples);
  }
  return weights;
}

/// From across the fibre to grazing: attenuations, exit azimuths and cos^2(theta_d) change most there.
constexpr float kInclinations[] = {0, 0.5f, 1, 1.3f, 1.45f, 1.52f, 1.56f};

std::vector<MarschnerParams> marschner_fibres() {
  std::vector<MarschnerParams> all;
  for (float beta : {1.0f, 7.5f, 15.0f}) {
    for (float sigma : {0.0f, 0.3f, 2.0f}) {
      MarschnerParams params;
      params.beta = beta;
      params.azimuthal_width = 2 * beta;
      params.absorption = Rgb(sigma);
      all.push_back(params);
    }
  }
  return all;
}

/// Lobes sampled about theta_o weigh up to 2,000 there. Three times the mean is where a pole cuts a wide
/// lobe, whose energy changes fastest between the places that the proposal knows.
TEST(FibreWeight, OfMarschnerStaysNearTheAlbedo) {
  for (const MarschnerParams& params : marschner_fibres()) {
    const FibreMaterial material(params);
    for (float theta : kInclinations) {
      for (float sign : {-1.0f, 1.0f}) {
        for (float h : {0.0f, 0.6f, -0.95f}) {
          const Weights w = weights_at(material, fibre_point_at(sign * theta, h), 4000, 5);
          EXPECT_LT(w.largest, 0.5 + 3.5 * w.mean) << params.beta << ' ' << params.absorption->x << ' '
                                                   << sign * theta << ' ' << h << ": mean " << w.mean;
        }
      }
    }
  }
}

/// Light in directions that are never sampled would be lost.
TEST(FibreWeight, OfMarschnerAveragesToTheIntegral) {
  for (const MarschnerParams& params : marschner_fibres()) {
    if (params.beta < 5) continue;  // quadrature needs lobes of some width
    const FibreMaterial material(params);
    for (float theta : kInclinations) {
      const FibrePoint point = fibre_point_at(-theta, 0.6f);
      const FibreBsdf bsdf = material.at(point);
      const double integral = sphere_integral(
          fibre_grid(point), [&](const V3f& w) { return bsdf.eval(w).total().y; }, 1000, 120);
      const Weights w = weights_at(material, point, 4000, 6);
      // Weights deviate by less than a third of their mean: 0.33 / sqrt(4000), four times.
      EXPECT_NEAR(w.mean / integral, 1, 0.021) << params.beta << ' ' << params.absorption->x << ' ' << theta;
    }
  }
}

/// A halved lobe loses energy, so a tangle of such fibres is dark; single samples of great weight make walks
/// that look as if they gained without end, and then all pale colours get too much absorption.
TEST(FibreWeight, ATangleOfHalvedMarschnerHasAnEnd) {
  MarschnerParams halved;
  halved.variant = MarschnerVariant::kHalved;
  const MarschnerMaterial material(halved);
  const auto brightness = [&](float absorption) {
    return tangle_reflectance(
        [&](const TangleHit& hit, const V3f& u) {
          return material.at(FibreFrame(hit.tangent, hit.wo), hit.h, Rgb(absorption)).sample(u);
        },
        2048, FibreLay::tangle());
  };
  EXPECT_NEAR(brightness(0.0004f), 0.335, 0.03);
  EXPECT_NEAR(brightness(0.02f), 0.265, 0.03);
}

/// Lobes of the others are sampled exactly: a sample weighs the albedo, but for hue.
TEST(FibreWeight, OfExactLobesIsTheAlbedoButForHue) {
  ChiangParams chiang;
  chiang.absorption = Rgb(0.05f, 0.4f, 1.5f);
  DeonParams deon;
  deon.absorption = chiang.absorption;
  for (const MaterialParams& params : {MaterialParams(chiang), MaterialParams(deon)}) {
    const FibreMaterial material(params);
    for (float theta : kInclinations) {
      const FibrePoint point = fibre_point_at(theta, 0.6f);
      const FibreBsdf bsdf = material.at(point);
      TestRandom random(7);
      for (int i = 0; i < 2000; ++i) {
        const std::optional<FibreSample> s = bsdf.sample(random.unit3());
        ASSERT_TRUE(s);
        const Rgb w = s->value.total() / s->value.pdf, a = bsdf.albedo();
        ASSERT_NEAR((w.x + w.y + w.z) / (a.x + a.y + a.z), 1, 1e-4);
      }
    }
  }
}

}  // namespace
}  // namespace pelage
