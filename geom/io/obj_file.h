// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>
#include <vector>

#include "geom/mesh.h"

namespace pelage {

struct Job;

/// Reads a cage from an OBJ file: v, vt, f (3 corners and more, negative indices), g, o, and the `t` lines of
/// OpenSubdiv's shapes (crease, corner, hole, interpolateboundary, creasemethod, smoothtriangles), whose
/// indices are those of the whole file from 0. A face belongs to the last g or o line above it. Faces without
/// texture coordinates in a file that has some get (0, 0). What else OBJ files hold is passed over.
///
/// Throws Error (kInput) with all problems, the first 20 with file and line: numbers that are malformed or
/// not finite, indices out of range, faces of fewer than 3 different vertices, hierarchical
/// edits, no faces.
ControlMesh read_obj(const std::filesystem::path& path);
/// The same, and throws Error (kStopped).
ControlMesh read_obj(const std::filesystem::path& path, const Job& job);

/// Only the vertex positions, for a pose of a cage that has `expected` vertices. Throws Error (kInput) when
/// the count differs or a number is malformed.
std::vector<V3f> read_obj_positions(const std::filesystem::path& path, size_t expected);

}  // namespace pelage
