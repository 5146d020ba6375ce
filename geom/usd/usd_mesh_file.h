// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "geom/interchange/geometry_file.h"
#include "geom/usd/usd_source.h"

namespace pelage {

/// Reads all Mesh prims of a USD file (.usda) as one cage, in world space with y up: the file states its up
/// axis. Lengths stay in the unit of the file. Each prim is an object of the mesh (`FaceNames`), and its
/// GeomSubsets are groups. Reads creases, corners, holes, st (or else the first primvar of texCoord2 values),
/// displayColor of vertices, and orientation. Follows references, payloads, sublayers, inherited prims and
/// selected variants. Of attributes with time samples, reads the earliest.
///
/// Throws Error (kInput) with line and column for malformed files, for indices out of range, for numbers that
/// are not finite, and for files without a mesh.
MeshFile read_usd_mesh(const UsdSource& source, const MeshReserve& reserve = {});

}  // namespace pelage
