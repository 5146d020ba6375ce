// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>

#include "geom/limit_surface.h"

namespace pelage {

/// What a mesh takes as a skin, estimated from its faces before anything is made of it.
struct SkinMemory {
  size_t making = 0;     ///< most at any moment while its topology is made
  size_t held = 0;       ///< by the topology and one surface, afterwards
  size_t triangles = 0;  ///< by its undivided triangles, what makes them included
  /// Most of all three in the order in which they come.
  size_t peak() const;
};

/// At least what is measured, and at most twice that on meshes of more than a few hundred faces. Costs some
/// nanoseconds a face. The mesh need not be valid.
SkinMemory skin_memory(const ControlMesh& mesh, SubdivisionScheme scheme);

}  // namespace pelage
