// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "lod/lod_view.h"

namespace pelage {

/// Diameter of the circle of confusion of a point, in scene units, in the plane of the point: the cone from
/// the lens through the point in focus, cut at the depth of the point [Ryu07]. Multiply by pixels_per_unit()
/// for the diameter of the blur in pixels. Points behind the camera are treated as points in the plane of the
/// camera.
float confusion_diameter(const LodView& view, const V3f& point);

}  // namespace pelage
