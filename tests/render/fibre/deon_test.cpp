// SPDX-License-Identifier: Apache-2.0
#include "render/fibre/deon.h"

#include <gtest/gtest.h>

#include "render/fibre/fibre_tracer.h"
#include "tests/render/fibre/fibre_models.h"

namespace pelage {
namespace {

/// The far field around a clear fibre against light traced through it, blurred by the same Gaussian.
TEST(Deon, AzimuthalDistributionIsThatOfTracedLight) {
  constexpr float kSigma = 0.3f;
  DeonParams params;
  params.alpha = 0;
  params.beta = 8;
  params.azimuthal_width = 12;
  params.absorption = Rgb(kSigma);
  const DeonMaterial material(params);
  for (float theta_o : {0.0f, 0.7f}) {
    constexpr int kBins = 24, kPaths = 60000;
    std::array<double, kBins> traced{}, model{};
    TestRandom random(77);
    for (int i = 0; i < kPaths; ++i) {
      const float h = 2 * (static_cast<float>(i) + 0.5f) / kPaths - 1;
      const FibrePath path = trace_fibre(TracedFibre{}, std::sin(theta_o), h, 21, i);
      const int p = path.entered ? 1 + path.reflections : 0;
      float phi = std::atan2(path.wi.z, path.wi.y) + 12 * kPi / 180 * normal_sample(random.unit());
      if (p > 2) phi = random.between(-kPi, kPi);  // the model's own simplification
      const int bin = static_cast<int>((wrapped_angle(phi) / (2 * kPi) + 0.5f) * kBins) % kBins;
      traced[bin] += std::exp(-kSigma * path.cortex) / kPaths;
    }
    // Integrated over inclinations the longitudinal functions are 1: what is left of rho is N.
    const FibrePoint point = fibre_point_at(theta_o, 0);
    const FibreFrame frame(point.tangents[0], point.wo);
    constexpr int kOffsets = 100, kInclinations = 150;
    for (int k = 0; k < kOffsets; ++k) {
      const float h = 2 * (static_cast<float>(k) + 0.5f) / kOffsets - 1;
      const DeonBsdf bsdf = material.at(frame, h, Rgb(1));
      for (int b = 0; b < kBins * 4; ++b) {
        const float phi = 2 * kPi * ((static_cast<float>(b) + 0.5f) / (4 * kBins) - 0.5f);
        for (int i = 0; i < kInclinations; ++i) {
          const float z = 2 * (static_cast<float>(i) + 0.5f) / kInclinations - 1;
          model[b / 4] += bsdf.eval(FibreAngles{z, std::sqrt(1 - z * z), phi}).total().x *
                          (4 * kPi / (kInclinations * 4 * kBins)) / kOffsets;
        }
      }
    }
    for (int b = 0; b < kBins; ++b)
      EXPECT_NEAR(model[b], traced[b], 1e-3 + 4.5 * std::sqrt(traced[b] / kPaths)) << theta_o << " bin " << b;
  }
}

}  // namespace
}  // namespace pelage
