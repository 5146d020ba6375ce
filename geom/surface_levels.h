// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "geom/limit_surface.h"

namespace pelage {

/// Levels that isolate smooth extraordinary vertices, 1 to 3. What is left at the last is a Gregory patch,
/// which with three levels stays within 1e-4 of the size of the cages of the tests from the limit surface; a
/// level more leaves a third of that. The faces of dense cages are so small a part of the whole that fewer
/// levels do as much; around each triangle three levels take 33 kB while they are made, two 17 and one 7.
inline int smooth_levels(const ControlMesh& mesh) {
  constexpr size_t kTwo = 6000;
  return mesh.face_count() > SurfaceTopology::kDenseFaces ? 1 : mesh.face_count() > kTwo ? 2 : 3;
}

}  // namespace pelage
