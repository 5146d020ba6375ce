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

/// A skin, or as much of it as a leaf stands on, ready to grow hair in one pose: made from posed cages when
/// something grows, and dropped again. Immutable. Thread safety: const members may be called from any thread.
struct SkinPose {
  std::vector<LimitSurface> keys;        ///< one per motion key
  std::unique_ptr<const SkinMesh> mesh;  ///< what `trees` are over; null without them
  std::vector<ClosestPointTree> trees;   ///< one per key, only for grooms that keep clear of the skin
  std::vector<M44f> transforms;          ///< of the character, per key: for strands that grow on no skin
  size_t open_key = 0, close_key = 0;    ///< when the shutter opens and closes
  float scale = 1;
  float length = 1;

  PosedSkin skin() const { return {keys, trees, scale, transforms, length}; }
  size_t bytes() const;
};

/// Adds the ptex faces that the first `count` strands of a leaf stand on, one or more times; none for a groom
/// on no skin.
void add_faces(const Groom& groom, size_t leaf, size_t count, std::vector<uint32_t>& faces);
/// The ptex faces that the strands of a leaf stand on, ascending; none for a groom on no skin.
std::vector<uint32_t> leaf_faces(const Groom& groom, size_t leaf);

}  // namespace pelage
