// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "lod/lod_view.h"

namespace pelage {

/// Returns the size in pixels of one scene unit at a point when the shutter opens. The size depends on the
/// distance of the point, not on its depth along the view axis. Therefore it is also defined for points
/// behind the camera, where objects may cast shadows.
float pixels_per_unit(const LodView& view, const V3f& point);
/// Returns the size in pixels of one scene unit at this distance from the camera. Distances below
/// LodView::near_distance count as near_distance.
float pixels_per_unit(const LodView& view, float distance);

}  // namespace pelage
