// SPDX-License-Identifier: Apache-2.0
#include "geom/pose_sequence.h"

#include <algorithm>
#include <cmath>

#include "base/check.h"
#include "geom/io/obj_file.h"

namespace pelage {

PoseSequence::PoseSequence(std::vector<std::filesystem::path> files, int first, bool cycle,
                           size_t cage_points)
    : files_(std::move(files)), first_(first), cycle_(cycle), cage_points_(cage_points) {
  PELAGE_CHECK(!files_.empty());
}

std::vector<V3f> PoseSequence::positions(double pose) const {
  const auto count = static_cast<double>(files_.size());
  double at = pose - first_;
  if (cycle_) at -= std::floor(at / count) * count;
  // Rounding may leave a cycle at its end; what is not finite becomes the first pose.
  at = at > 0 ? std::min(at, cycle_ ? count : count - 1) : 0;
  const double below = std::floor(at);
  const auto t = static_cast<float>(at - below);
  const size_t from = static_cast<size_t>(below) % files_.size();
  const size_t to = t > 0 ? (from + 1) % files_.size() : from;
  std::vector<V3f> result = read_obj_positions(files_[from], cage_points_);
  if (to != from) {
    const std::vector<V3f> next = read_obj_positions(files_[to], cage_points_);
    for (size_t i = 0; i < result.size(); ++i) result[i] = result[i] * (1 - t) + next[i] * t;
  }
  return result;
}

}  // namespace pelage
