// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <functional>
#include <vector>

#include "rib/scene/rib_mesh_reader.h"

namespace pelage {

/// Points of a parametric surface on a grid over the unit square, row by row: (columns + 1) x (rows + 1).
struct RibGrid {
  int columns = 0, rows = 0;
  std::vector<V3f> points;

  /// `point` returns the point at (column / columns, row / rows).
  RibGrid(int column_count, int row_count, const std::function<V3f(int column, int row)>& point);
};

/// Returns a mesh of a quadrilateral for each cell of the grid. `samples`: the surface at each time of a
/// motion block, with grids of the same size, or a single one. Points that coincide in all samples are one
/// vertex, so that normals are smooth across seams and at poles. Faces without three different vertices are
/// left out; if no face has any, the mesh is empty. Texture coordinates are the parameters.
RibMesh grid_mesh(const std::vector<RibGrid>& samples);

}  // namespace pelage
