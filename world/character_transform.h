// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "base/vector.h"
#include "world/scene_schema.h"

namespace pelage {

/// Returns the matrix M from the object space of a character to world space at a frame. Points are row
/// vectors: p * M. The matrix scales first, then rotates about x, y and z in this order, then translates.
M44f character_matrix(const TransformParams& transform, double frame);

/// Returns whether the transform is animated, because one of its values has at least two keys.
bool moves(const TransformParams& transform);

}  // namespace pelage
