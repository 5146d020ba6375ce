// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "geom/limit_surface.h"

namespace pelage {

/// Number of levels that isolate smooth extraordinary vertices, 1 to 3. At the last level, a Gregory patch
/// fills the rest. With three levels, the distance between this patch and the limit surface was at most 1e-4
/// of the size of the test cages; each further level reduces the error to a third. Faces of dense cages are
/// so small relative to the whole that fewer levels suffice. Temporary memory around each triangle is 33 kB
/// for three levels, 17 for two and 7 for one.
inline int smooth_levels(const ControlMesh& mesh) {
  constexpr size_t kTwo = 6000;
  return mesh.face_count() > SurfaceTopology::kDenseFaces ? 1 : mesh.face_count() > kTwo ? 2 : 3;
}

}  // namespace pelage
