// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "base/vector.h"
#include "geom/mesh.h"

namespace pelage {

struct CageFace {
  V3f center{0};    ///< mean of its vertices
  double area = 0;  ///< of a polygon that need not be flat
};

/// Calls `use(const CageFace&)` for each face of a mesh.
template <class Use>
void for_each_cage_face(const ControlMesh& mesh, const Use& use) {
  const uint32_t* corner = mesh.face_vertices.data();
  for (const uint32_t count : mesh.face_sizes) {
    V3d normal(0), center(0);
    const V3d first(mesh.positions[corner[0]]);
    for (uint32_t i = 0; i < count; ++i) {
      const V3d at(mesh.positions[corner[i]]);
      center += at;
      if (i > 0 && i + 1 < count) normal += (at - first).cross(V3d(mesh.positions[corner[i + 1]]) - first);
    }
    use(CageFace{V3f(center / static_cast<double>(count)), 0.5 * normal.length()});
    corner += count;
  }
}

}  // namespace pelage
