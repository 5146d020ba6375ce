// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <limits>
#include <span>
#include <vector>

#include "base/vector.h"
#include "render/accel/primitive_sink.h"
#include "render/raster/range.h"

namespace pelage {

/// Divides the lines of a tile into the cells of a grid, by position, and stores for each cell the depth
/// beyond which all of its lines are occluded.
class DepthGrid {
 public:
  static constexpr int kMaxSide = 32;

  /// Begins a grid for this count of lines, with positions in this range by axis.
  void begin(size_t lines, const Range (&positions)[2]) {
    side_ = std::clamp(static_cast<int>(std::sqrt(static_cast<float>(lines) / kLinesPerCell)), 1, kMaxSide);
    for (size_t axis = 0; axis < 2; ++axis) {
      low_[axis] = positions[axis].low;
      inverse_size_[axis] = static_cast<float>(side_) / std::max(positions[axis].size(), 1e-30f);
    }
    cell_of_line_.assign(lines, 0);
    max_.assign(static_cast<size_t>(side_) * static_cast<size_t>(side_), kNothing);
    far_ = kNothing;
  }
  /// Places a line. `line`: its index in the arrays of TileLines.
  void place(size_t line, const V2f& position) {
    const int cell = clamped(at(position.y, 1)) * side_ + clamped(at(position.x, 0));
    cell_of_line_[line] = static_cast<uint16_t>(cell);
  }
  /// Updates the depths of all cells. `depths`: of the first primitive of each line; infinity: none.
  void update(const float* depths);

  int side() const { return side_; }
  float low(size_t axis) const { return low_[axis]; }
  float inverse_size(size_t axis) const { return inverse_size_[axis]; }
  /// Returns the depth beyond which nothing can be seen.
  float far() const { return far_; }
  /// Whether a primitive with this footprint cannot be seen.
  bool hides(const ViewFootprint& f) const {
    if (f.depth > far_) return true;
    for (int row = f.first[1]; row <= f.last[1]; ++row) {
      const float* max = &max_[static_cast<size_t>(row * side_)];
      for (int column = f.first[0]; column <= f.last[0]; ++column) {
        if (f.depth <= max[column]) return false;
      }
    }
    return true;
  }
  /// Whether the cell of a line is in the footprint.
  bool contains(const ViewFootprint& f, size_t line) const {
    const int cell = cell_of_line_[line], row = cell / side_, column = cell % side_;
    return row >= f.first[1] && row <= f.last[1] && column >= f.first[0] && column <= f.last[0];
  }
  /// Returns the max memory for this count of lines, in bytes.
  static size_t bytes(size_t lines) {
    return lines * sizeof(uint16_t) + size_t{kMaxSide} * kMaxSide * sizeof(float);
  }

 private:
  static constexpr float kLinesPerCell = 8;
  static constexpr float kNothing = std::numeric_limits<float>::infinity();

  float at(float position, size_t axis) const { return (position - low_[axis]) * inverse_size_[axis]; }
  int clamped(float at) const {
    return static_cast<int>(std::clamp(at, 0.0f, static_cast<float>(side_ - 1)));
  }

  int side_ = 1;
  float low_[2] = {0, 0}, inverse_size_[2] = {1, 1};
  std::vector<uint16_t> cell_of_line_;
  std::vector<float> max_;  // by cell, row by row
  float far_ = kNothing;
};

}  // namespace pelage
