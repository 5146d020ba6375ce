// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>
#include <memory>
#include <utility>
#include <vector>

#include "base/ledger.h"
#include "base/vector.h"
#include "geom/io/host_geometry.h"
#include "geom/mesh.h"

namespace pelage {

/// The positions of a cage between two poses of a sequence, in object space. They are interpolated on demand.
/// Keeps the two poses in memory.
class BlendedPose {
 public:
  using Positions = std::shared_ptr<const std::vector<V3f>>;
  BlendedPose() = default;
  /// `t`: 0 at `from`, 1 at `to`. `to` may be null if t is 0.
  BlendedPose(Positions from, Positions to, float t) : from_(std::move(from)), to_(std::move(to)), t_(t) {}

  size_t size() const { return from_->size(); }
  V3f operator[](size_t vertex) const {
    const V3f& a = (*from_)[vertex];
    return to_ ? a * (1 - t_) + (*to_)[vertex] * t_ : a;
  }

 private:
  Positions from_, to_;
  float t_ = 0;
};

/// Poses of a cage, one OBJ file per pose, or all in the memory of the host. The first file is shown at frame
/// `first`, and each following file `frames_per_pose` frames after the one before it. Positions between two
/// poses are interpolated linearly. With `cycle`, the sequence repeats endlessly, before its first frame as
/// well as after its last. Without `cycle`, the first pose is shown before the sequence and the last pose
/// after it.
///
/// A file is read when a frame first needs it. The last poses read are kept in memory, up to `kMaxBytes`, so
/// that a crowd in nearby frames reads each file once. Thread safety: const members may be called from any
/// thread.
class PoseSequence {
 public:
  /// Max memory for the positions that a sequence keeps, at most an eighth of the ledger's limit and only
  /// where there is room; two poses are kept even if they are larger. Charged to the ledger as memory of
  /// skins.
  static constexpr int64_t kMaxBytes = int64_t(64) << 20;

  /// `order`: of the mesh as its file has it. `frames_per_pose`: number of frames from one pose to the next.
  /// `to_scene`: from the space of the files to object space (row vectors: p * M).
  PoseSequence(std::vector<std::filesystem::path> files, int first, bool cycle, const MeshOrder& order,
               MemoryLedger& ledger, double frames_per_pose = 1, const M44f& to_scene = M44f());
  /// Does the same with poses of the host, which host_poses() has checked against the mesh.
  PoseSequence(std::shared_ptr<const HostPoses> poses, int first, bool cycle, const MeshOrder& order,
               MemoryLedger& ledger, double frames_per_pose = 1, const M44f& to_scene = M44f());
  PoseSequence(PoseSequence&&) noexcept;
  ~PoseSequence();

  /// Returns the positions of all control points at a frame, in object space. Throws Error (kInput) with the
  /// name of a file that is missing, damaged, or does not fit the order. Throws Error (kMemory) before a pose
  /// is read that does not fit the ledger's limit.
  std::vector<V3f> positions(double frame) const;
  /// Reads the poses around a frame. Throws the same errors.
  BlendedPose at(double frame) const;

 private:
  class Files;
  std::unique_ptr<Files> files_;
  int first_;
  bool cycle_;
  double frames_per_pose_;
};

}  // namespace pelage
