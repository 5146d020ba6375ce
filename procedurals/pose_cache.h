// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <memory>
#include <mutex>
#include <set>
#include <tuple>
#include <vector>

#include "base/ledger.h"
#include "procedurals/skin_pose.h"

namespace pelage {

/// Owns the memory of poses. Whole poses with trees are expensive. The cache keeps the most recently used
/// whole poses alive, one per thread, so that consecutive chunks of a character share one pose. A partial
/// pose is made for a single leaf and freed after it. Thread safety: all members may be called from any
/// thread.
///
/// Each thread uses at most one whole pose that the cache does not keep. From the start, the cache therefore
/// charges 2 * threads whole poses of the largest size, and one partial pose per thread, to the skins. Poses
/// made later need no further budget.
class PoseCache {
 public:
  PoseCache(int threads, MemoryLedger& ledger);
  ~PoseCache();
  PoseCache(const PoseCache&) = delete;
  PoseCache& operator=(const PoseCache&) = delete;

  /// Announces whole poses of up to `bytes` bytes.
  void reserve(size_t bytes);
  /// Announces that leaves of a groom will grow on partial poses with `keys` times. Groom and topology must
  /// outlive the cache.
  void reserve_for_leaves(const Groom& groom, const SurfaceTopology& topology, size_t keys);
  /// Announces partial poses with `keys` times that may contain all faces.
  void reserve_for_whole(const SurfaceTopology& topology, size_t keys);
  /// Keeps `pose` alive until as many other poses as there are threads have been used after it.
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
