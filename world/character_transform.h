// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "base/vector.h"
#include "world/scene_schema.h"

namespace pelage {

/// Matrix from a character's object space to world space at a frame, for row vectors (p * M): scale, then
/// rotation about x, y, z, then translation.
M44f character_matrix(const TransformParams& transform, double frame);

/// Whether the transform is animated.
bool moves(const TransformParams& transform);

}  // namespace pelage
