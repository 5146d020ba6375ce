// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <filesystem>
#include <functional>
#include <string>
#include <string_view>
#include <vector>

#include "geom/mesh.h"

namespace pelage {

/// A cage of a USD file, and one line per kind of thing that was skipped.
struct UsdMeshFile {
  ControlMesh mesh;
  std::vector<std::string> warnings;
};

/// Called before each prim with the memory that the mesh needs up to its end, in bytes. May throw.
using UsdMeshReserve = std::function<void(int64_t bytes)>;

/// Reads all Mesh prims of a USD file (.usda) as one cage, in world space with y up: the file states its up
/// axis. Lengths stay in the unit of the file. Each prim is an object of the mesh (`FaceNames`), and its
/// GeomSubsets are groups. Reads creases, corners, holes, st (or else the first primvar of texCoord2 values),
/// displayColor of vertices, and orientation. Follows references, payloads, sublayers, inherited prims and
/// selected variants. Of attributes with time samples, reads the earliest.
///
/// Throws Error (kInput) with line and column for malformed files, for indices out of range, for numbers that
/// are not finite, and for files without a mesh.
UsdMeshFile read_usd_mesh(const std::filesystem::path& path, const UsdMeshReserve& reserve = {});
/// Does the same with a text. `path`: for messages.
UsdMeshFile read_usd_mesh(const std::filesystem::path& path, std::string_view text,
                          const UsdMeshReserve& reserve = {});

}  // namespace pelage
