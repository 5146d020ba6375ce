// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "lod/lod_view.h"

namespace pelage {

/// Diameter of the disc that a lens smears a point over, in scene units, in the plane of the point: the cone
/// from the edge of the lens through the point in focus, cut at the depth of the point [Ryu07]. Times
/// pixels_per_unit() it is the diameter of the blur. Points behind the camera count as in its plane.
float confusion_diameter(const LodView& view, const V3f& point);

}  // namespace pelage
