// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>

#include "procedurals/chunk_bounds.h"
#include "render/accel/fur/fur_tree.h"

namespace pelage {

/// Boxes of the largest subtrees of a tree: at least `parts` of them, as far as there are leaves. Scene
/// space, over the whole shutter; linear in time when there is motion. They hold every hit.
ChunkBounds subtree_bounds(const FurTreeView& tree, size_t parts);

}  // namespace pelage
