// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <memory>
#include <vector>

#include "geom/closest_point.h"
#include "geom/limit_surface.h"
#include "geom/tessellation.h"
#include "groom/groom.h"

namespace pelage {

/// A skin of a character in a frame, or only some of its faces, with everything needed to grow strands on it.
/// It is made from posed cages when strands grow, and freed afterwards. Immutable. Thread safety: const
/// members may be called from any thread.
struct SkinPose {
  std::vector<LimitSurface> keys;        ///< the skin at each key, in order of time
  std::unique_ptr<const SkinMesh> mesh;  ///< mesh that `trees` refer to; null if there are no trees
  std::vector<ClosestPointTree> trees;   ///< one per key; only for grooms with the operator push_out
  std::vector<M44f> transforms;          ///< object to world space, one per key; for strands without a skin
  size_t open_key = 0, close_key = 0;    ///< indices of the keys at which the shutter opens and closes
  float scale = 1;                       ///< CharacterPose::scale
  float length = 1;                      ///< CharacterPose::length

  PosedSkin skin() const { return {keys, trees, scale, transforms, length}; }
  size_t bytes() const;
};

/// Appends the ptex faces on which the first `count` strands of a leaf grow to `faces`, in no particular
/// order and possibly with repetitions. Appends none for a groom without a skin.
void add_faces(const Groom& groom, size_t leaf, size_t count, std::vector<uint32_t>& faces);
/// Returns the ptex faces on which the strands of a leaf grow, ascending and without repetitions. Returns
/// none for a groom without a skin.
std::vector<uint32_t> leaf_faces(const Groom& groom, size_t leaf);

}  // namespace pelage
