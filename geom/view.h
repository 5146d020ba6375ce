// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "base/vector.h"

namespace pelage {

/// Camera data for level of detail, tessellation and bounds: the position of the camera, and the data to
/// compute the size on screen of a length at a distance.
struct View {
  V3f position{0};
  /// Pixels per unit of the tangent of the viewing angle: image height / (2 tan(fov / 2)).
  float focal_pixels = 1;
  float near_distance = 1e-12f;  ///< smallest distance that pixels_per_unit() uses, scene units

  /// Returns the number of pixels per scene unit at `point`. Uses the distance rather than the depth, because
  /// objects behind the camera cast shadows too.
  float pixels_per_unit(const V3f& point) const;
};

}  // namespace pelage
