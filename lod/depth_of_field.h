// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "lod/lod_view.h"

namespace pelage {

/// Returns the diameter of the circle of confusion of a point, in scene units at the depth of the point
/// [Ryu07]. The circle is the cross-section, at this depth, of the double cone from the rim of the lens
/// through a point in focus. Multiply by pixels_per_unit() to get the diameter of the blur in pixels. Points
/// behind the camera are treated as points in the plane of the camera.
float confusion_diameter(const LodView& view, const V3f& point);

}  // namespace pelage
