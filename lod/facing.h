// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "lod/lod_view.h"

namespace pelage {

/// How skin with this unit normal faces the camera when the shutter opens: the cosine of the angle between
/// the normal and the direction to the eye; -1 faces away. 1 where the normal is 0 (unknown).
float facing(const LodView& view, const V3f& point, const V3f& normal);

}  // namespace pelage
