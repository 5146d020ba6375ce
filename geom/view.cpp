// SPDX-License-Identifier: Apache-2.0
#include "geom/view.h"

#include <algorithm>

namespace pelage {

float View::pixels_per_unit(const V3f& point) const {
  return focal_pixels / std::max((point - position).length(), near_distance);
}

}  // namespace pelage
