// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>

#include "procedurals/bounds/chunk_bounds.h"
#include "render/accel/fur/fur_tree.h"

namespace pelage {

/// Divides a tree into subtrees by opening the largest subtree repeatedly, until there are at least `parts`
/// subtrees or only leaves. Returns the boxes of the subtrees in scene space, over the whole shutter. With
/// motion, the boxes are linear in time. Together, the boxes contain every hit.
ChunkBounds subtree_bounds(const FurTreeView& tree, size_t parts);

}  // namespace pelage
