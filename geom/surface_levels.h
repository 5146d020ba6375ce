// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "geom/limit_surface.h"

namespace pelage {

/// Returns the number of subdivision levels that isolate smooth extraordinary vertices, 1 to 3. The region
/// that remains after the last level is filled by a Gregory patch. With three levels, the distance between
/// this patch and the limit surface was at most 1e-4 of the size of the test cages; each further level
/// reduces it to a third.
///
/// Dense cages get fewer levels, because their faces are small relative to the whole cage. Temporary memory
/// around each triangle is 33 kB for three levels, 17 kB for two and 7 kB for one.
inline int smooth_levels(const ControlMesh& mesh) {
  constexpr size_t kTwo = 6000;
  return mesh.face_count() > SurfaceTopology::kDenseFaces ? 1 : mesh.face_count() > kTwo ? 2 : 3;
}

}  // namespace pelage
