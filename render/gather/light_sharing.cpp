// SPDX-License-Identifier: Apache-2.0
#include "render/gather/light_sharing.h"

#include <algorithm>

namespace pelage {

void LightSharing::begin(size_t lights, size_t groups) {
  lights_ = lights;
  guess_.begin(groups);
  profile_.begin(groups);
  gather_points_.clear();
}

LightSharing::GatherPoint& LightSharing::at(uint32_t gather_point, size_t light) {
  const size_t index = gather_point * lights_ + light;
  if (index >= gather_points_.size()) gather_points_.resize(std::max(index + 1, 2 * gather_points_.size()));
  return gather_points_[index];
}

void LightSharing::add_unoccluded(uint32_t gather_point, size_t light, const Rgb* lobes) {
  GatherPoint& to = at(gather_point, light);
  for (size_t g = 0; g < kLobeGroups; ++g) to.unoccluded[g] += lobes[g];
}

void LightSharing::add_arriving(uint32_t gather_point, size_t light, const Rgb* lobes, float factor) {
  GatherPoint& to = at(gather_point, light);
  for (size_t g = 0; g < kLobeGroups; ++g) to.arriving[g] += lobes[g] * factor;
}

void LightSharing::finish(size_t gather_points) {
  gather_points_.resize(gather_points * lights_);
  for (GatherPoint& gather_point : gather_points_) {
    for (size_t g = 0; g < kLobeGroups; ++g) {
      for (int c = 0; c < 3; ++c) {
        const float all = gather_point.unoccluded[g][c];
        gather_point.arriving[g][c] = all > 0 ? gather_point.arriving[g][c] / all : 0.0f;
      }
    }
  }
}

}  // namespace pelage
