// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <functional>
#include <limits>
#include <string>
#include <vector>

#include "geom/mesh.h"
#include "geom/strands.h"

namespace pelage {

/// The strands of a scene file: all its curves as one batch, in world space.
struct CurvesFile {
  StrandArrays strands;  ///< one motion key; ids are indices; no roots
  bool has_widths = false;
  std::vector<std::string> warnings;  ///< one per kind of thing that was skipped or approximated
};

struct CurvesReadOptions {
  int64_t max_bytes = std::numeric_limits<int64_t>::max();  ///< max memory that reading may use
};

/// The cage of a scene file: all its meshes as one, in world space.
struct MeshFile {
  ControlMesh mesh;
  std::vector<std::string> warnings;  ///< one per kind of thing that was skipped
};

/// A reader of meshes calls it before each mesh with the memory, in bytes, that the cage needs up to the end
/// of this mesh, including temporary memory. May throw.
using MeshReserve = std::function<void(int64_t bytes)>;

}  // namespace pelage
