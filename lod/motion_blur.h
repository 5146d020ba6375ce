// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "lod/lod_view.h"

namespace pelage {

/// Distance by which a point moves across the picture while the shutter is open, in scene units at the depth
/// of the point. It is the motion relative to the camera, projected onto the plane perpendicular to the line
/// of sight [Ryu07]. Multiply by pixels_per_unit() for the length of the blur in pixels.
float motion_across(const LodView& view, const V3f& at_open, const V3f& at_close);

/// The component of this motion across a line through the point. `line`: direction of the line at shutter
/// open, a unit vector, shorter where the direction is uncertain. For a line along the line of sight or
/// without direction, all motion is across.
float motion_across_line(const LodView& view, const V3f& at_open, const V3f& at_close, const V3f& line);

}  // namespace pelage
