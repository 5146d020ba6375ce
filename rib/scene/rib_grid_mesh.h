// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <functional>

#include "geom/mesh.h"

namespace pelage {

/// Returns a mesh of columns x rows quadrilaterals over the unit square: that of a parametric surface.
/// `point` returns the point at (column / columns, row / rows). Vertices at the same position are one, so
/// that normals are smooth across seams and at poles. Faces without three different vertices are left out; if
/// no face has any, the mesh is empty. Texture coordinates are the parameters.
ControlMesh grid_mesh(int columns, int rows, const std::function<V3f(int column, int row)>& point);

}  // namespace pelage
