// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <functional>
#include <memory>
#include <vector>

#include "exchange/scene_export.h"
#include "rib/host/coat_tree.h"
#include "world/frame_coats.h"

namespace pelage {

/// All frames of an export, posed. Posed skins take a few kilobytes each; strands are grown when they are
/// written. Thread safety: const members may be called from any thread.
class PosedFrames {
 public:
  /// Throws the errors of pose_frame(), and Error (kMemory) if the cages of all frames do not fit.
  PosedFrames(const ExportSource& source, const Job& job);

  size_t count() const { return numbers_.size(); }
  int number(size_t frame) const { return numbers_[frame]; }
  const FrameParts& parts(size_t frame) const { return parts_[frame]; }
  /// The frames that differ for a skin or coat: all, or only the first if it is the same in all of them.
  std::vector<size_t> different_skins(size_t skin) const;
  std::vector<size_t> different_coats(size_t coat) const;
  /// Returns the times of so many motion keys in frame `frame`, in frames.
  std::vector<double> times(size_t frame, int keys) const;

 private:
  std::vector<int> numbers_;
  std::vector<FrameParts> parts_;
  MemoryCharge charge_;
};

/// Calls `use(leaf)` for each leaf of a coat, on several threads at once, as far as the memory of growth has
/// room. Throws Error: kMemory if one leaf does not fit, kStopped when the job is stopped.
void for_each_leaf_at_once(const CoatTree& tree, const Job& job, const std::function<void(size_t leaf)>& use);

}  // namespace pelage
