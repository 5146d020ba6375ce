// SPDX-License-Identifier: Apache-2.0
#include "geom/pose_sequence.h"

#include <algorithm>
#include <cmath>
#include <mutex>

#include "base/check.h"
#include "base/memory_budget.h"
#include "geom/io/obj_file.h"

namespace pelage {

/// The files of a sequence, and the poses read from them.
class PoseSequence::Files {
 public:
  using Positions = BlendedPose::Positions;

  Files(std::vector<std::filesystem::path> paths, std::shared_ptr<const HostPoses> given,
        const MeshOrder& order, MemoryLedger& ledger, const M44f& to_scene)
      : paths_(std::move(paths)),
        given_(std::move(given)),
        order_(order),
        ledger_(ledger),
        to_scene_(to_scene),
        read_(paths_.size()) {
    PELAGE_CHECK(!paths_.empty());
  }
  ~Files() { ledger_.charge(MemoryTag::kSkins, -charged_); }

  size_t count() const { return paths_.size(); }

  Positions get(size_t file) {
    const std::lock_guard lock(mutex_);
    if (!read_[file]) {
      const int64_t limit = ledger_.limit();
      const int64_t max = (limit > 0 ? std::min(kMaxBytes, limit / 8) : kMaxBytes) / pose_bytes();
      while (kept_.size() >= 2 && (std::ssize(kept_) >= max || !has_room(ledger_, pose_bytes()))) {
        charge(-1);
        read_[kept_.front()].reset();
        kept_.erase(kept_.begin());
      }
      require_memory(ledger_, pose_bytes(), "the pose " + paths_[file].string());
      std::vector<V3f> positions = given_ ? given_->poses()[file] : read_obj_positions(paths_[file], order_);
      if (to_scene_ != M44f()) {
        for (V3f& point : positions) point *= to_scene_;
      }
      read_[file] = std::make_shared<const std::vector<V3f>>(std::move(positions));
      kept_.push_back(file);
      charge(1);
    }
    return read_[file];
  }

 private:
  int64_t pose_bytes() const {
    return static_cast<int64_t>(std::max<size_t>(1, order_.vertices) * sizeof(V3f));
  }
  void charge(int64_t poses) {
    const int64_t bytes = poses * pose_bytes();
    ledger_.charge(MemoryTag::kSkins, bytes);
    charged_ += bytes;
  }

  const std::vector<std::filesystem::path> paths_;  // or the name of `given_` for each pose
  const std::shared_ptr<const HostPoses> given_;    // null: the poses are in files
  const MeshOrder order_;
  MemoryLedger& ledger_;
  const M44f to_scene_;
  std::mutex mutex_;             // guards the following
  std::vector<Positions> read_;  // of each file, or null
  std::vector<size_t> kept_;     // files in memory, the one read first first
  int64_t charged_ = 0;
};

PoseSequence::PoseSequence(std::vector<std::filesystem::path> files, int first, bool cycle,
                           const MeshOrder& order, MemoryLedger& ledger, double frames_per_pose,
                           const M44f& to_scene)
    : files_(std::make_unique<Files>(std::move(files), nullptr, order, ledger, to_scene)),
      first_(first),
      cycle_(cycle),
      frames_per_pose_(frames_per_pose) {}
PoseSequence::PoseSequence(std::shared_ptr<const HostPoses> poses, int first, bool cycle,
                           const MeshOrder& order, MemoryLedger& ledger, double frames_per_pose,
                           const M44f& to_scene)
    : files_(std::make_unique<Files>(std::vector<std::filesystem::path>(poses->poses().size(), poses->name()),
                                     poses, order, ledger, to_scene)),
      first_(first),
      cycle_(cycle),
      frames_per_pose_(frames_per_pose) {}
PoseSequence::PoseSequence(PoseSequence&&) noexcept = default;
PoseSequence::~PoseSequence() = default;

BlendedPose PoseSequence::at(double frame) const {
  const auto count = static_cast<double>(files_->count());
  double at = (frame - first_) / frames_per_pose_;
  if (cycle_) at -= std::floor(at / count) * count;
  // Rounding may yield the end of a cycle; non-finite values become the first pose.
  at = at > 0 ? std::min(at, cycle_ ? count : count - 1) : 0;
  const double below = std::floor(at);
  const auto t = static_cast<float>(at - below);
  const size_t from = static_cast<size_t>(below) % files_->count();
  const size_t to = t > 0 ? (from + 1) % files_->count() : from;
  Files::Positions first = files_->get(from);
  return {std::move(first), to != from ? files_->get(to) : nullptr, t};
}

std::vector<V3f> PoseSequence::positions(double frame) const {
  const BlendedPose pose = at(frame);
  std::vector<V3f> result(pose.size());
  for (size_t i = 0; i < result.size(); ++i) result[i] = pose[i];
  return result;
}

}  // namespace pelage
