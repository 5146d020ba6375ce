// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>

#include "geom/interchange/geometry_file.h"

namespace pelage {

/// Reads all meshes and subdivision meshes of an Alembic file (.abc, Ogawa) as one cage, in world space. The
/// file states neither unit nor up axis, so both stay. Each mesh is an object of the cage (`FaceNames`), and
/// its face sets are groups. Corners of faces are clockwise in the file, and turned. Reads creases, corners,
/// holes, uv, and the parameters Cd and color of vertices. Of several time samples, reads the earliest.
/// `reserve`: as in read_usd_mesh().
///
/// Throws Error (kInput) with the object or the position in bytes for malformed files, for indices out of
/// range, for numbers that are not finite, and for files without a mesh.
MeshFile read_alembic_mesh(const std::filesystem::path& path, const MeshReserve& reserve = {});

}  // namespace pelage
