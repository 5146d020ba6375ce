// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "base/vector.h"

namespace pelage {

/// What level of detail, tessellation and bounds need to know of a camera: where it is and how large a length
/// at a distance appears.
struct View {
  V3f position{0};
  float focal_pixels = 1;  ///< pixels per unit of tangent: image height / (2 tan(fov / 2))
  float near_distance = 1e-3f;

  /// Pixels per scene unit at `point`. Distance, not depth: what stands behind the camera casts shadows too.
  float pixels_per_unit(const V3f& point) const;
};

}  // namespace pelage
