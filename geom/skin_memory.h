// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>

#include "geom/limit_surface.h"

namespace pelage {

/// Estimate of the memory of a skin, in bytes, from the faces of its mesh, before the skin is made.
struct SkinMemory {
  size_t making = 0;     ///< max while its topology is made
  size_t held = 0;       ///< held afterwards by the topology and one surface
  size_t triangles = 0;  ///< for the triangles of the skin if no edge is divided, including temporary memory
  /// Max memory in use at any time, over making the topology, holding it, and making the triangles.
  size_t peak() const;
};

/// Estimates the memory of a skin. The estimate is never below the measured memory. For meshes of more than a
/// few hundred faces, it is at most twice the measured memory, and at most four times if the mesh is not
/// manifold. Takes about 0.2 us and 40 temporary bytes per face. The mesh need not be valid.
SkinMemory skin_memory(const ControlMesh& mesh, SubdivisionScheme scheme);

}  // namespace pelage
