// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "base/vector.h"
#include "world/scene_schema.h"

namespace pelage {

/// Matrix from a character's object space to world space at a frame, for row vectors (p * M): scale first,
/// then rotation about x, y, z, then translation.
M44f character_matrix(const TransformParams& transform, double frame);

/// Whether the character is anywhere else at some other frame.
bool moves(const TransformParams& transform);

}  // namespace pelage
