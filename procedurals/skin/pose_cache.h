// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <memory>
#include <mutex>
#include <set>
#include <tuple>
#include <vector>

#include "base/ledger.h"
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

  PosedSkin skin() const { return {keys, trees, scale, transforms, length, true}; }
  size_t bytes() const;
};

/// Appends the ptex faces on which the first `count` strands of a leaf grow to `faces`, in no particular
/// order and possibly with repetitions. Appends none for a groom without a skin.
void add_faces(const Groom& groom, size_t leaf, size_t count, std::vector<uint32_t>& faces);
/// Returns the ptex faces on which the strands of a leaf grow, ascending and without repetitions. Returns
/// none for a groom without a skin.
std::vector<uint32_t> leaf_faces(const Groom& groom, size_t leaf);

/// Keeps recently used poses of skins alive, and charges the memory of all poses to the ledger. A whole pose
/// contains the whole skin and may contain trees, which are expensive to make. The cache keeps as many whole
/// poses as there are threads, namely the most recently used ones, so that consecutive chunks of a character
/// share one pose. A partial pose contains only the faces below one chunk. It is made for this chunk and
/// freed after the chunk has been grown. Thread safety: all members may be called from any thread.
///
/// Poses must be announced with their sizes before they are made. Each thread uses at most one whole pose
/// that the cache does not keep, and one partial pose. Therefore each announcement makes the cache charge, to
/// MemoryTag::kSkins, enough for 2 * threads whole poses of the largest announced size and for `threads`
/// partial poses of the largest announced size. Making poses later needs no further memory budget.
class PoseCache {
 public:
  PoseCache(int threads, MemoryLedger& ledger);
  ~PoseCache();
  PoseCache(const PoseCache&) = delete;
  PoseCache& operator=(const PoseCache&) = delete;

  /// Announces whole poses that take up to `bytes` bytes each.
  void reserve(size_t bytes);
  /// Announces partial poses with `keys` keys, each for one leaf of a groom. Groom and topology must outlive
  /// the cache.
  void reserve_for_leaves(const Groom& groom, const SurfaceTopology& topology, size_t keys);
  /// Announces partial poses with `keys` keys, which may contain all faces of the skin.
  void reserve_for_whole(const SurfaceTopology& topology, size_t keys);
  /// Records the use of a whole pose. The cache keeps this pose alive until as many other poses as there are
  /// threads have been used after it.
  void keep(std::shared_ptr<const SkinPose> pose);

 private:
  void raise(size_t& largest, size_t bytes, size_t count);

  const size_t threads_;
  MemoryLedger& ledger_;
  std::mutex mutex_;                                     // guards the following
  std::vector<std::shared_ptr<const SkinPose>> recent_;  // most recently used last
  size_t largest_ = 0, largest_part_ = 0;
  std::set<std::tuple<const Groom*, const SurfaceTopology*, size_t>> expected_;
};

}  // namespace pelage
