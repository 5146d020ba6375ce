// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>
#include <vector>

#include "base/vector.h"

namespace pelage {

/// Poses of a cage, one OBJ file each, numbered from `first`; between whole numbers, positions blend
/// linearly. A cycle goes on for ever in both directions, otherwise the first and the last pose hold.
class PoseSequence {
 public:
  /// `cage_points`: how many every file must have.
  PoseSequence(std::vector<std::filesystem::path> files, int first, bool cycle, size_t cage_points);

  /// Positions of all control points at a pose number, object space. Reads the files it needs. Throws Error
  /// (kInput) naming a file that is missing, damaged or has another number of points.
  std::vector<V3f> positions(double pose) const;

 private:
  std::vector<std::filesystem::path> files_;
  int first_;
  bool cycle_;
  size_t cage_points_;
};

}  // namespace pelage
