// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "base/vector.h"

namespace pelage {

/// What level of detail needs to know of a camera. What it sees at one time:
struct LodPose {
  V3f position{0};
  V3f right{1, 0, 0}, up{0, 1, 0}, forward{0, 0, -1};  ///< orthonormal
  float focal_pixels = 1;  ///< pixels per unit of tangent: image height / (2 tan(fov / 2))
};

/// A camera over the shutter, and its lens. Detail depends on nothing else (law 3): not on which ray comes
/// first, nor on how tight a box is. World space.
struct LodView {
  LodPose open, close;  ///< when the shutter opens and closes; equal for a camera that stands still
  float near_distance = 1e-3f;
  float lens_diameter = 0;   ///< scene units; 0 is a pinhole
  float focus_distance = 1;  ///< along the view axis
};

}  // namespace pelage
