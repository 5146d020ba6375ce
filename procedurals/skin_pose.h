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

/// A skin in one pose, or its part below one leaf, ready for growing hair. Made from posed cages when
/// something grows, and freed afterwards. Immutable. Thread safety: const members may be called from any
/// thread.
struct SkinPose {
  std::vector<LimitSurface> keys;        ///< one per motion key
  std::unique_ptr<const SkinMesh> mesh;  ///< the mesh of `trees`; null if there are no trees
  std::vector<ClosestPointTree> trees;   ///< one per key, only for grooms with push_out
  std::vector<M44f> transforms;          ///< of the character, one per key; used for strands without a skin
  size_t open_key = 0, close_key = 0;    ///< keys at which the shutter opens and closes
  float scale = 1;
  float length = 1;

  PosedSkin skin() const { return {keys, trees, scale, transforms, length}; }
  size_t bytes() const;
};

/// Appends to `faces` the ptex faces below the first `count` strands of a leaf, possibly with repetitions.
/// Appends none for a groom without a skin.
void add_faces(const Groom& groom, size_t leaf, size_t count, std::vector<uint32_t>& faces);
/// The ptex faces below the strands of a leaf, ascending; none for a groom without a skin.
std::vector<uint32_t> leaf_faces(const Groom& groom, size_t leaf);

}  // namespace pelage
