// SPDX-License-Identifier: Apache-2.0
#include "lod/depth_of_field.h"

#include <algorithm>
#include <cmath>

namespace pelage {

float confusion_diameter(const LodView& view, const V3f& point) {
  if (!(view.lens_diameter > 0)) return 0;
  const float depth = std::max(0.0f, (point - view.open.position).dot(view.open.forward));
  return view.lens_diameter * std::abs(depth - view.focus_distance) / view.focus_distance;
}

}  // namespace pelage
