// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "lod/lod_view.h"

namespace pelage {

/// How skin of this unit normal at a point faces the camera when the shutter opens: the cosine of the angle
/// between the normal and the way to the eye, -1 where it is turned away. 1 where the normal is 0: not known.
float facing(const LodView& view, const V3f& point, const V3f& normal);

}  // namespace pelage
