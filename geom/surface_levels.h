// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <algorithm>
#include <cmath>

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

/// Returns the number of subdivision levels around semi-sharp edges, sharp corners and non-manifold parts.
/// `tangled_faces`: tangled_face_count().
///
/// Six levels resolve the sharpness of edges up to 6. Around non-manifold vertices, each level about doubles
/// the memory, to 450 kB per face for six levels, and reduces the error, which is 1 % of a face for three. So
/// a few faces get six levels, and each doubling of their number costs one level.
inline int sharp_levels(const ControlMesh& mesh, size_t tangled_faces) {
  constexpr int kMax = 6;
  constexpr size_t kFewTangled = 128;
  float sharpest = 0;
  const auto add = [&](const auto& tags) {
    for (const auto& tag : tags) {
      const bool infinite = tag.sharpness >= 10;
      sharpest = std::max(sharpest, infinite && tangled_faces > 0 ? 0.0f : tag.sharpness);
    }
  };
  add(mesh.creases);
  add(mesh.corners);
  int levels = smooth_levels(mesh);
  if (tangled_faces == 0) return sharpest > 0 ? kMax : levels;
  int affordable = kMax;
  for (size_t few = kFewTangled; tangled_faces > few && affordable > 0; few *= 2) --affordable;
  levels = std::max(levels, affordable);
  return std::max(levels, static_cast<int>(std::ceil(std::min(sharpest, float(kMax)))));
}

}  // namespace pelage
