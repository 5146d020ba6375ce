// SPDX-License-Identifier: Apache-2.0
#include "render/gather/light_sharing.h"

#include <algorithm>

namespace pelage {

void LightSharing::begin(size_t lights) {
  lights_ = lights;
  guess_.begin(lights);
  knots_.clear();
}

LightSharing::Knot& LightSharing::at(uint32_t knot, size_t light) {
  const size_t index = knot * lights_ + light;
  if (index >= knots_.size()) knots_.resize(std::max(index + 1, 2 * knots_.size()));
  return knots_[index];
}

void LightSharing::add_unoccluded(uint32_t knot, size_t light, const Rgb* lobes) {
  Knot& to = at(knot, light);
  for (size_t g = 0; g < kLobeGroups; ++g) to.unoccluded[g] += lobes[g];
}

void LightSharing::add_arriving(uint32_t knot, size_t light, const Rgb* lobes, float factor) {
  Knot& to = at(knot, light);
  for (size_t g = 0; g < kLobeGroups; ++g) to.arriving[g] += lobes[g] * factor;
}

void LightSharing::finish(size_t knots) {
  knots_.resize(knots * lights_);
  for (Knot& knot : knots_) {
    for (size_t g = 0; g < kLobeGroups; ++g) {
      for (int c = 0; c < 3; ++c) {
        const float all = knot.unoccluded[g][c];
        knot.arriving[g][c] = all > 0 ? knot.arriving[g][c] / all : 0.0f;
      }
    }
  }
}

}  // namespace pelage
