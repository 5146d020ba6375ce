// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>

#include "geom/limit_surface.h"

namespace pelage {

/// Memory of a skin made from a mesh, estimated from its faces in advance.
struct SkinMemory {
  size_t making = 0;     ///< max while its topology is made
  size_t held = 0;       ///< held afterwards by the topology and one surface
  size_t triangles = 0;  ///< for the triangles of the undivided skin, including temporary memory
  /// Max over all three phases.
  size_t peak() const;
};

/// The estimate is at least the measured memory. For meshes of more than a few hundred faces, it is at most
/// twice that memory. Takes some nanoseconds per face. The mesh need not be valid.
SkinMemory skin_memory(const ControlMesh& mesh, SubdivisionScheme scheme);

}  // namespace pelage
