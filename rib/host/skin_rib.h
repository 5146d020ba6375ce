// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <span>

#include "geom/limit_surface.h"
#include "geom/mesh.h"
#include "rib/syntax/rib_writer.h"

namespace pelage {

/// Writes a skin: SubdivisionMesh with creases, corners and holes; or PointsGeneralPolygons with scheme none.
/// Texture coordinates are "facevarying float[2] st". `cages`: positions of the control points, one list per
/// motion key; `times`: one per key. Several keys become a motion block. Unless all cages are the mesh's own
/// positions, these are "vertex point Pref", the skin at rest.
///
/// RI has no tag for creases by Chaikin's rule without string arguments, which old renderers do not read.
/// Such a skin has the attribute "pelage" "integer chaikin" [1].
void write_skin(RibWriter& rib, const ControlMesh& mesh, SubdivisionScheme scheme, BoundaryRule boundary,
                std::span<const std::vector<V3f>> cages, std::span<const float> times);

}  // namespace pelage
