// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cmath>
#include <cstdint>

#include "render/accel/accel.h"
#include "render/scene/render_scene.h"

namespace pelage {

/// A place on a skin in its rest pose.
struct RestPlace {
  V3f position{0};
  V3f normal{0};    ///< of any length
  float scale = 1;  ///< size in world space / size at rest
};

/// Returns where a strand grows at rest. For a strand without a skin, the position is its attribute
/// kRestPositions or else its root, and the normal is its first direction.
RestPlace rest_place(const FurPart& part, const Strands& strand);
/// Returns the rest place of a hit on a skin. For a skin without a rest pose, this is the place of the hit
/// itself.
RestPlace rest_place(const SkinPart& part, const Ray& ray, const Hit& hit, const SkinMesh& triangle);

/// Returns the largest component of a vector, and the sign of this component, as a number below 6.
inline uint32_t side_of(const V3f& v) {
  uint32_t axis = 0;
  for (uint32_t i = 1; i < 3; ++i) {
    if (std::abs(v[static_cast<int>(i)]) > std::abs(v[static_cast<int>(axis)])) axis = i;
  }
  return 2 * axis + (v[static_cast<int>(axis)] < 0 ? 1 : 0);
}

}  // namespace pelage
