// SPDX-License-Identifier: Apache-2.0
// Tested in tests/render/gather/gather_integrator_test.cpp.
#include "render/gather/tile_samples.h"

#include <algorithm>

namespace pelage {

void TileSamples::clear() {
  samples.clear();
  seen_lights.clear();
  fronts.clear();
  points.clear();
  light_rays.clear();
  unoccluded.clear();
  layer_of_knot.clear();
  layers = 0;
}

size_t TileSamples::bytes_per_sample(size_t lights) {
  // Each light is either seen directly or scattered by a point; each of its rays has an entry in an order.
  const size_t light =
      std::max(sizeof(SeenLight), sizeof(LightRay) + kLobeGroups * sizeof(Rgb) + sizeof(uint64_t));
  return sizeof(Sample) + sizeof(VisiblePoint) + lights * light;
}

}  // namespace pelage
