// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>
#include <memory>
#include <vector>

#include "base/ledger.h"
#include "base/vector.h"

namespace pelage {

/// Poses of a cage, one OBJ file each, numbered from `first`. Frame `first` shows pose `first`. Positions are
/// interpolated linearly between poses. A cycle repeats in both directions. Without a cycle, the first pose
/// also holds before the sequence, and the last pose after it.
///
/// A file is read when first needed. Up to `kMaxBytes` of positions are kept, so that a crowd reads each pose
/// once. Thread safety: const members may be called from any thread.
class PoseSequence {
 public:
  /// Positions kept in memory per sequence, charged to the skins.
  static constexpr size_t kMaxBytes = size_t(64) << 20;

  /// `cage_points`: number of points that every file must have. `frames_per_pose`: frames from one pose to
  /// the next.
  PoseSequence(std::vector<std::filesystem::path> files, int first, bool cycle, size_t cage_points,
               MemoryLedger& ledger, double frames_per_pose = 1);
  PoseSequence(PoseSequence&&) noexcept;
  ~PoseSequence();

  /// Positions of all control points at a frame, object space. Throws Error (kInput) naming a file that
  /// is missing, damaged or has another number of points.
  std::vector<V3f> positions(double frame) const;

 private:
  class Files;
  std::unique_ptr<Files> files_;
  int first_;
  bool cycle_;
  double frames_per_pose_;
};

}  // namespace pelage
