// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "lod/lod_view.h"

namespace pelage {

/// How far a point moves across the picture while the shutter is open, in scene units where it stands: its
/// motion as the camera sees it, so that of the camera counts, projected on the plane perpendicular to the
/// line from the eye to the point [Ryu07]. Times pixels_per_unit() it is the length of the blur.
float motion_across(const LodView& view, const V3f& at_open, const V3f& at_close);

/// How far across a line through the point that lies along `line` when the shutter opens: a unit vector,
/// shorter where the line is not certain. Of a line that points to the eye, and of one of no direction, all
/// of the motion is across.
float motion_across_line(const LodView& view, const V3f& at_open, const V3f& at_close, const V3f& line);

}  // namespace pelage
