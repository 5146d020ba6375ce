// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <memory>
#include <mutex>
#include <set>
#include <tuple>
#include <vector>

#include "base/ledger.h"
#include "procedurals/skin/skin_pose.h"

namespace pelage {

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
