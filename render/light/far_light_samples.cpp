// SPDX-License-Identifier: Apache-2.0
#include "render/light/far_light_samples.h"

#include <algorithm>

#include "base/hash.h"

namespace pelage {

FarLightSamples::FarLightSamples(const LightSet& lights, uint64_t seed, bool stores)
    : lights_(lights), points_(lights.size()) {
  for (size_t light = 0; stores && light < lights.size(); ++light) {
    if (!lights.light(light).is_infinitely_far()) continue;
    points_[light].reserve(size_t{kSide} * kSide);
    for (uint32_t y = 0; y < kSide; ++y) {
      for (uint32_t x = 0; x < kSide; ++x) {
        const uint64_t random = hash64(random_use("drawn lights"), seed, light, x, y);
        const auto within = [](uint32_t cell, float u) {
          return std::min((static_cast<float>(cell) + u) / static_cast<float>(kSide), kBelowOne);
        };
        const V2f u(within(x, unit_float(random)), within(y, unit_float(mix64(random))));
        const auto sample = lights.light(light).sample(V3f(0), u);
        points_[light].push_back(sample ? Point{sample->direction, sample->radiance, sample->pdf} : Point{});
      }
    }
  }
}

size_t FarLightSamples::bytes(const LightSet& lights) {
  size_t far = 0;
  for (size_t light = 0; light < lights.size(); ++light) far += lights.light(light).is_infinitely_far();
  return far * kSide * kSide * sizeof(Point);
}

}  // namespace pelage
