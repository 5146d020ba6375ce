// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>
#include <vector>

#include "geom/mesh.h"

namespace pelage {

struct Job;

/// Reads a cage from an OBJ file. Reads v, vt, f (3 or more corners, also negative indices), g, o and usemtl.
/// Three more numbers of a v line are the colour of the vertex, a fourth number alone is a weight. Also
/// reads the `t` lines of OpenSubdiv's shapes: crease, corner, hole, interpolateboundary, creasemethod and
/// smoothtriangles. Indices in `t` lines refer to the whole file and start at 0. Ignores all other
/// statements.
///
/// A face belongs to the group of the last g or o line above it, and to the object and the material of the
/// last o and usemtl line. Vertices without a colour are white where others have one. If only some faces have
/// texture coordinates, the other faces get (0, 0).
///
/// Throws Error (kInput) with all problems: malformed or non-finite numbers, indices out of range, faces with
/// fewer than 3 different vertices, hierarchical edits, no faces. The first 20 problems are listed with file
/// and line, the others are only counted.
ControlMesh read_obj(const std::filesystem::path& path);
/// Reads a cage like read_obj(path), but throws Error (kStopped) when the job is stopped.
ControlMesh read_obj(const std::filesystem::path& path, const Job& job);

/// Returns the memory in bytes that reading an OBJ file takes at most: its text, and three times as much in
/// arrays that grow by doubling. 0 if the file cannot be opened, which reading reports.
int64_t obj_reading_bytes(const std::filesystem::path& path);

/// Reads only the vertex positions, for a pose of a mesh of this order. Throws Error (kInput) when the file
/// has another number of vertices, or has faces that are not those of the mesh, in the same order: then its
/// vertices may have another order too. Also throws it when a number is malformed or not finite. A file
/// without faces is taken as it is.
std::vector<V3f> read_obj_positions(const std::filesystem::path& path, const MeshOrder& order);

}  // namespace pelage
