// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <memory>
#include <vector>

#include "geom/closest_point.h"
#include "geom/limit_surface.h"
#include "geom/tessellation.h"
#include "groom/groom.h"

namespace pelage {

/// A skin of one character in the pose of a frame, world space: what grows on it keeps it alive. Limit
/// surfaces and trees are per motion key, at even times over the shutter.
struct PosedCharacterSkin {
  std::vector<LimitSurface> keys;
  std::shared_ptr<const SkinMesh> mesh;  ///< the frame's one tessellation
  std::vector<ClosestPointTree> trees;  ///< over `mesh`; empty unless a groom asks for the inside of the skin
  float scale = 1;
  std::vector<M44f> transforms;  ///< of the character, per key: for strands that grow on no skin

  PosedSkin pose() const { return {keys, trees, scale, transforms}; }
  size_t bytes() const {
    size_t sum = mesh->bytes();
    for (const LimitSurface& key : keys) sum += key.bytes();
    for (const ClosestPointTree& tree : trees) sum += tree.bytes();
    return sum;
  }
};

}  // namespace pelage
