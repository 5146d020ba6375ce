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

/// Answers for the memory of poses. Whole ones with trees are dear: those that were used last are kept alive,
/// one per thread, so that a run of chunks of one character makes its pose once. The part of a pose that one
/// leaf stands on is made for it and dropped. Thread safety: all members may be called from any thread.
///
/// Each thread uses at most one whole pose besides those that are kept, so 2 * threads of the largest are
/// charged to the skins from the start, and one part per thread: a pose that is made later takes nothing from
/// the budget any more.
class PoseCache {
 public:
  PoseCache(int threads, MemoryLedger& ledger);
  ~PoseCache();
  PoseCache(const PoseCache&) = delete;
  PoseCache& operator=(const PoseCache&) = delete;

  /// Says that whole poses of `bytes` will be made.
  void reserve(size_t bytes);
  /// Says that leaves of a groom will grow on their part of poses of `keys` times. Both outlive the cache.
  void reserve_for_leaves(const Groom& groom, const SurfaceTopology& topology, size_t keys);
  /// Says that parts of poses of `keys` times will be made that may hold all faces.
  void reserve_for_whole(const SurfaceTopology& topology, size_t keys);
  /// Keeps `pose` alive until as many others as there are threads have been used after it.
  void keep(std::shared_ptr<const SkinPose> pose);

 private:
  void raise(size_t& largest, size_t bytes, size_t count);

  const size_t threads_;
  MemoryLedger& ledger_;
  std::mutex mutex_;                                     // guards what follows
  std::vector<std::shared_ptr<const SkinPose>> recent_;  // the last used last
  size_t largest_ = 0, largest_part_ = 0;
  std::set<std::tuple<const Groom*, const SurfaceTopology*, size_t>> expected_;
};

}  // namespace pelage
