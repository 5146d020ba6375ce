// SPDX-License-Identifier: Apache-2.0
#include "render/gather/tile_samples.h"

namespace pelage {

void TileSamples::begin(const Tile& of, uint32_t samples_per_pixel, size_t lights) {
  tile = of;
  const size_t count = pixels() * samples_per_pixel;
  const auto start = [](auto& items, size_t max) {
    items.clear();
    items.reserve(max);
  };
  start(samples, count);
  start(seen_lights, count);
  start(points, count);
  start(light_rays, count * lights * targets(lights));
  start(unoccluded, count * lights * kLobeGroups);
  start(zone_of_gather_point, count);
  start(patch_of_gather_point, count);
  fronts.assign(pixels(), {});
  zones = patches = 0;
}

size_t TileSamples::bytes_per_sample(size_t lights) {
  return sizeof(Sample) + sizeof(VisiblePoint) + 2 * sizeof(uint32_t) +
         lights * (sizeof(SeenLight) + targets(lights) * sizeof(LightRay) + kLobeGroups * sizeof(Rgb));
}

}  // namespace pelage
