// SPDX-License-Identifier: Apache-2.0
#include "lod/size.h"

#include <algorithm>

namespace pelage {

float pixels_per_unit(const LodView& view, float distance) {
  return view.open.focal_pixels / std::max(distance, view.near_distance);
}

float pixels_per_unit(const LodView& view, const V3f& point) {
  return pixels_per_unit(view, (point - view.open.position).length());
}

}  // namespace pelage
