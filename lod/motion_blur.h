// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "lod/lod_view.h"

namespace pelage {

/// Returns the distance by which a point moves across the picture while the shutter is open, in scene units
/// at the depth of the point. This is the length of the motion relative to the camera, projected onto the
/// plane perpendicular to the line of sight [Ryu07]. Multiply by pixels_per_unit() to get the length of the
/// blur in pixels.
float motion_across(const LodView& view, const V3f& at_open, const V3f& at_close);

/// Returns the component of the motion of motion_across() that is perpendicular to a line through the point,
/// such as a strand. `line`: direction of the line when the shutter opens. A unit vector means a certain
/// direction, a shorter vector a less certain one, 0 an unknown one. If `line` is 0 or parallel to the line
/// of sight, returns all of motion_across().
float motion_across_line(const LodView& view, const V3f& at_open, const V3f& at_close, const V3f& line);

}  // namespace pelage
