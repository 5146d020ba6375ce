// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <vector>

#include "geom/mesh.h"

namespace pelage {

/// How the faces around a vertex are joined.
enum class VertexFan : uint8_t {
  kClosed,  ///< they surround the vertex
  kOpen,    ///< the vertex is at a border, or has no face
  /// Not manifold: three or more faces meet at an edge of the vertex, two faces run along an edge in the same
  /// direction, or several fans meet at the vertex.
  kTangled,
};

/// Returns the fan of each vertex. Needs 8 temporary bytes per corner and per vertex. The mesh need not be
/// valid.
std::vector<VertexFan> vertex_fans(const ControlMesh& mesh);

/// Returns the number of faces with a tangled vertex. `fans`: vertex_fans().
size_t tangled_face_count(const ControlMesh& mesh, const std::vector<VertexFan>& fans);

}  // namespace pelage
