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

const std::filesystem::path& PoseSequence::file(int64_t pose) const {
  const auto count = static_cast<int64_t>(files_.size());
  int64_t index = pose - first_;
  index = cycle_ ? ((index % count) + count) % count : std::clamp<int64_t>(index, 0, count - 1);
  return files_[static_cast<size_t>(index)];
}

std::vector<V3f> PoseSequence::positions(double pose) const {
  const double below = std::floor(pose);
  const auto number = static_cast<int64_t>(below);
  const auto t = static_cast<float>(pose - below);
  std::vector<V3f> result = read_obj_positions(file(number), cage_points_);
  if (t > 0 && file(number) != file(number + 1)) {
    const std::vector<V3f> next = read_obj_positions(file(number + 1), cage_points_);
    for (size_t i = 0; i < result.size(); ++i) result[i] = result[i] * (1 - t) + next[i] * t;
  }
  return result;
}

}  // namespace pelage
