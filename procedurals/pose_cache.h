// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <memory>
#include <mutex>
#include <vector>

#include "base/ledger.h"
#include "procedurals/skin_pose.h"

namespace pelage {

/// Keeps the poses that were used last alive, one per thread, so that a run of chunks of one character makes
/// its pose once. Thread safety: all members may be called from any thread.
///
/// Each thread uses at most one pose besides those that are kept, so 2 * threads of the largest are charged
/// to the skins from the start: a pose that is made later takes nothing from the budget any more.
class PoseCache {
 public:
  PoseCache(int threads, MemoryLedger& ledger);
  ~PoseCache();
  PoseCache(const PoseCache&) = delete;
  PoseCache& operator=(const PoseCache&) = delete;

  /// Says that poses of `bytes` will be made.
  void expect(size_t bytes);
  /// Keeps `pose` alive until as many others as there are threads have been used after it.
  void keep(std::shared_ptr<const SkinPose> pose);

 private:
  const size_t threads_;
  MemoryLedger& ledger_;
  std::mutex mutex_;                                     // guards what follows
  std::vector<std::shared_ptr<const SkinPose>> recent_;  // the last used last
  size_t largest_ = 0;
};

}  // namespace pelage
