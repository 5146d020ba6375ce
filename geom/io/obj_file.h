// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>
#include <vector>

#include "geom/mesh.h"

namespace pelage {

struct Job;

/// Reads a cage from an OBJ file: v, vt, f (3 corners and more, negative indices), g, o, and the `t` lines of
/// OpenSubdiv's shapes (crease, corner, hole, interpolateboundary, creasemethod, smoothtriangles), whose
/// indices refer to the whole file and start at 0. A face belongs to the last g or o line above it. Faces
/// without texture coordinates get (0, 0) if other faces have some. Ignores everything else.
///
/// Throws Error (kInput) with all problems, the first 20 with file and line: malformed or non-finite numbers,
/// indices out of range, faces with fewer than 3 different vertices, hierarchical edits, no faces.
ControlMesh read_obj(const std::filesystem::path& path);
/// The same, but throws Error (kStopped) when the job is stopped.
ControlMesh read_obj(const std::filesystem::path& path, const Job& job);

/// Reads only the vertex positions, for a pose of a cage with `expected` vertices. Throws Error (kInput) when
/// the count differs or a number is malformed.
std::vector<V3f> read_obj_positions(const std::filesystem::path& path, size_t expected);

}  // namespace pelage
