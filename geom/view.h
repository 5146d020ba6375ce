// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "base/vector.h"

namespace pelage {

/// Camera data for level of detail, tessellation and bounds: its position, and the apparent size of a length
/// at a distance.
struct View {
  V3f position{0};
  float focal_pixels = 1;  ///< pixels per unit of tangent: image height / (2 tan(fov / 2))
  float near_distance = 1e-3f;

  /// Pixels per scene unit at `point`. Uses distance rather than depth, because objects behind the camera
  /// cast shadows too.
  float pixels_per_unit(const V3f& point) const;
};

}  // namespace pelage
