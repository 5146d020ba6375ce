// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <span>
#include <string>
#include <vector>

#include "geom/limit_surface.h"
#include "geom/mesh.h"
#include "rib/syntax/rib_parameters.h"

namespace pelage {

/// The mesh of one request, in the space of the request.
struct RibMesh {
  ControlMesh cage;       ///< with the positions of the first sample
  std::vector<V3f> rest;  ///< positions at rest ("Pref"), as given; empty if they are not
  SubdivisionScheme scheme = SubdivisionScheme::kNone;
  BoundaryRule boundary = BoundaryRule::kEdgeAndCorner;
  std::vector<std::vector<V3f>> samples;  ///< positions at each time of the motion block
  std::vector<std::string> ignored;       ///< tags and parts that are not supported, for warnings
};

/// Converts the requests SubdivisionMesh, HierarchicalSubdivisionMesh, PointsPolygons, PointsGeneralPolygons,
/// Polygon and GeneralPolygon. `samples`: the same request at each time of a motion block, or a single one.
/// Only "P" of the further samples is read. Throws Error (kInput) for wrong types and counts, and for indices
/// beyond the points.
///
/// Subdivision meshes have the schemes "catmull-clark", "loop" and "bilinear", and the tags crease, corner,
/// hole, creasemethod and interpolateboundary; without this last tag, all boundary edges and corners are
/// sharp. Polygons are not subdivided; holes within polygons are ignored. Faces with fewer than 3 different
/// vertices are dropped, so the mesh may have no faces. Texture coordinates are "st", or "s" and "t".
/// "vertex point Pref" is the mesh at rest.
RibMesh read_mesh(std::span<RibStatement> samples, const RibDeclarations& declarations);

}  // namespace pelage
