// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "lod/lod_view.h"

namespace pelage {

/// Pixels per scene unit at a point when the shutter opens. Uses distance rather than depth, so that objects
/// behind the camera, which may cast shadows, have a size too.
float pixels_per_unit(const LodView& view, const V3f& point);
/// The same at a distance from the camera.
float pixels_per_unit(const LodView& view, float distance);

}  // namespace pelage
