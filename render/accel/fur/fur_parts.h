// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>

#include "procedurals/chunk_bounds.h"
#include "render/accel/fur/fur_tree.h"

namespace pelage {

/// Boxes of the largest subtrees of a tree: at least `parts` of them, if there are enough leaves. Scene
/// space, over the whole shutter; linear in time when there is motion. They contain every hit.
ChunkBounds subtree_bounds(const FurTreeView& tree, size_t parts);

}  // namespace pelage
