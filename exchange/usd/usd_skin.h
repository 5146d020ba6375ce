// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <span>
#include <string>
#include <vector>

#include "geom/limit_surface.h"
#include "geom/mesh.h"
#include "geom/usd/usd_writer.h"

namespace pelage {

/// The vertices of a mesh at a time, in frames.
struct UsdMeshSample {
  double time = 0;
  std::span<const V3f> points;
};

/// Writes a Mesh prim: faces, creases, corners, holes, st, vertex colours, and one GeomSubset per group of
/// faces. A single sample is written without a time. `schemas`: names for apiSchemas, such as
/// "MaterialBindingAPI". Leaves the prim open, so that the caller can add to it.
void open_usd_mesh(UsdWriter& usd, const std::string& name, const std::string& schemas,
                   const ControlMesh& mesh, SubdivisionScheme scheme, BoundaryRule boundary,
                   std::span<const UsdMeshSample> samples);

}  // namespace pelage
