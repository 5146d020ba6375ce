// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "lod/lod_view.h"

namespace pelage {

/// Returns the cosine of the angle between the unit normal of the skin and the direction to the camera when
/// the shutter opens: 1 if the skin faces the camera, -1 if it faces away. Returns 1 if the normal is 0
/// (unknown).
float facing(const LodView& view, const V3f& point, const V3f& normal);

}  // namespace pelage
