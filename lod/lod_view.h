// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "base/vector.h"

namespace pelage {

/// Position, orientation and focal length of the level-of-detail camera at one time.
struct LodPose {
  V3f position{0};
  V3f right{1, 0, 0}, up{0, 1, 0}, forward{0, 0, -1};  ///< orthonormal
  float focal_pixels = 1;  ///< focal length in pixels: image height / (2 tan(fov / 2))
};

/// The level-of-detail camera while the shutter is open, and its lens. World space. The level of detail of a
/// strand depends only on this camera and the strand's root (law 3), not on the order of rays or the size of
/// boxes.
struct LodView {
  LodPose open, close;          ///< when the shutter opens and closes; equal for a static camera
  float near_distance = 1e-3f;  ///< scene units; pixels_per_unit() treats nearer points as at this distance
  float lens_diameter = 0;      ///< scene units; 0 for a pinhole camera
  float focus_distance = 1;     ///< scene units along `forward`
};

}  // namespace pelage
