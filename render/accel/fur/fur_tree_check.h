// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>

#include "render/accel/fur/fur_tree.h"

namespace pelage {

// Checks of a tree that was read from a file. Rays may be traced through a tree that passes all of them.

/// Whether the number of motion keys, the grid and the frame are possible. Ignores nodes and leaves.
bool has_possible_grid(const FurTreeView& tree);

/// Whether every reference leads to a node or leaf of the tree, every node except the root is the child of
/// exactly one node, and the depth is within the limit of the kernels. The tree must have nodes.
bool has_possible_nodes(const FurTreeView& tree, size_t node_bytes, size_t leaf_bytes);

/// Whether every segment number in the leaves is below `count`, and rays cannot hit lanes without a number.
/// Call after has_possible_nodes().
bool has_possible_segments(const FurTreeView& tree, size_t node_bytes, size_t count);

}  // namespace pelage
