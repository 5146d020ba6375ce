// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "base/value_readers.h"
#include "geom/tessellation.h"

namespace pelage {

struct Job;

/// Reads the OBJ file that a scene names, as triangles without subdivision. Normals are those of the faces,
/// averaged at vertices by area. `faces` and `vertex_uv` stay empty. Throws the errors of read_obj(), and
/// Error (kInput) when there is no such file, with the position in the scene.
SkinMesh read_named_mesh(const AssetPath& file, const Job& job);

}  // namespace pelage
