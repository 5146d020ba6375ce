// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "base/vector.h"

namespace pelage {

/// Camera data for level of detail at one time.
struct LodPose {
  V3f position{0};
  V3f right{1, 0, 0}, up{0, 1, 0}, forward{0, 0, -1};  ///< orthonormal
  float focal_pixels = 1;  ///< pixels per unit of tangent: image height / (2 tan(fov / 2))
};

/// A camera over the shutter, and its lens. Detail depends on nothing else (law 3): neither on the order of
/// rays nor on the tightness of boxes. World space.
struct LodView {
  LodPose open, close;  ///< when the shutter opens and closes; equal for a static camera
  float near_distance = 1e-3f;
  float lens_diameter = 0;   ///< scene units; 0 is a pinhole
  float focus_distance = 1;  ///< along the view axis
};

}  // namespace pelage
