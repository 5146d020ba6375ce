// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>

#include "geom/limit_surface.h"

namespace pelage {

/// Memory of a skin made from a mesh, estimated from its faces in advance.
struct SkinMemory {
  size_t making = 0;     ///< max while its topology is made
  size_t held = 0;       ///< by the topology and one surface, afterwards
  size_t triangles = 0;  ///< by its undivided triangles, including temporary memory
  /// Max over all three phases.
  size_t peak() const;
};

/// At least the measured memory, and at most twice that for meshes of more than a few hundred faces. Takes
/// some nanoseconds per face. The mesh need not be valid.
SkinMemory skin_memory(const ControlMesh& mesh, SubdivisionScheme scheme);

}  // namespace pelage
