// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>

#include "geom/mesh.h"

namespace pelage {

/// Reads a cage from an OBJ file: v, vt, f (3 corners and more, negative indices), g, o, and the `t crease`,
/// `t corner` and `t hole` lines of OpenSubdiv's shapes, whose indices are global. Throws Error (kInput) with
/// file and line for every index out of range, number that is not finite, and face that is degenerate beyond
/// use.
ControlMesh read_obj(const std::filesystem::path& path);

/// Only the vertex positions, for a pose of a cage that has `expected` vertices. Throws Error (kInput) when
/// the count differs.
std::vector<V3f> read_obj_positions(const std::filesystem::path& path, size_t expected);

}  // namespace pelage
