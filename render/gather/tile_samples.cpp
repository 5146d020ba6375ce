// SPDX-License-Identifier: Apache-2.0
// Tested in tests/render/gather/gather_integrator_test.cpp.
#include "render/gather/tile_samples.h"

namespace pelage {

void TileSamples::begin(size_t pixels, size_t count, size_t lights) {
  const auto start = [](auto& items, size_t max) {
    items.clear();
    items.reserve(max);
  };
  start(samples, count);
  start(seen_lights, count);
  start(points, count);
  start(light_rays, count * lights);
  start(unoccluded, count * lights * kLobeGroups);
  start(layer_of_knot, count);
  fronts.assign(pixels, {});
  layers = 0;
}

size_t TileSamples::bytes_per_sample(size_t lights) {
  return sizeof(Sample) + sizeof(VisiblePoint) + sizeof(uint32_t) +
         lights * (sizeof(SeenLight) + sizeof(LightRay) + kLobeGroups * sizeof(Rgb));
}

}  // namespace pelage
