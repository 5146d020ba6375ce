// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <algorithm>
#include <array>
#include <cstddef>
#include <cstdint>
#include <limits>
#include <span>
#include <vector>

#include "base/vector.h"

namespace pelage {

/// A camera sample in a tile's frame: at depth z it is at a + z b.
struct TileLine {
  V2f a{0}, b{0};
  float time = 0;
  uint32_t random = 0;  ///< Ray::random
};

/// What a line meets first.
struct TileWinner {
  static constexpr uint32_t kNothing = ~0u;     ///< as `chunk`
  static constexpr uint32_t kTraced = ~0u - 1;  ///< as `chunk`: a ray must decide

  uint32_t chunk = kNothing, primitive = 0;
};

/// A range of values.
struct Range {
  float low = std::numeric_limits<float>::infinity(), high = -low;

  void extend(float x) {
    low = std::min(low, x);
    high = std::max(high, x);
  }
  void extend(const Range& o) {
    low = std::min(low, o.low);
    high = std::max(high, o.high);
  }
  Range widened(float by) const { return {low - by, high + by}; }
  bool is_empty() const { return !(low <= high); }
  float size() const { return high - low; }
};

/// The lines of all camera samples of a tile, sorted for rasterising, and what each meets first so far.
///
/// Lines are sorted into groups of similar time and lens position, by rows of cells within a group, and by
/// columns within a row: the lines that a shape may meet are a few consecutive ranges. A line's cell follows
/// from its position at the reference depth, divided by that depth.
class TileLines {
 public:
  /// A group of lines.
  struct Group {
    Range a[2];  ///< of TileLine::a, by axis
    Range time;
    uint32_t first_start = 0;  ///< in starts_
  };
  /// Consecutive lines.
  struct Run {
    uint32_t begin = 0, end = 0;
  };
  /// The arrays that kernels use, padded by kPadding lines.
  struct Arrays {
    float *ax, *ay, *bx, *by, *time, *depth;
    uint32_t *chunk, *primitive, *random;
  };
  static constexpr size_t kPadding = 16;
  static constexpr int kMaxRows = 48, kMaxColumns = 2 * kMaxRows;

  /// Takes the lines of all slots. `reference`: a depth at which lines of the same pixel are close, or
  /// infinity. Lines of different times, or with different a, are put into several groups.
  void assign(std::span<const TileLine> lines, float reference);

  size_t size() const { return place_.size(); }
  std::span<const Group> groups() const { return groups_; }
  bool has_lens() const { return has_lens_; }
  Arrays arrays();
  /// The rows of cells that a range of positions meets; none where first > last.
  struct Rows {
    int first = 0, last = -1;
  };
  Rows rows(const Range& y) const {
    return {std::max(cell(y.low, 1), 0), std::min(cell(y.high, 1), rows_ - 1)};
  }
  /// The positions of a row.
  Range row_range(int row) const {
    return {low_[1] + static_cast<float>(row) * size_[1], low_[1] + static_cast<float>(row + 1) * size_[1]};
  }
  /// The lines of a group in the cells of a row that a range of positions meets.
  Run run(const Group& group, int row, const Range& x) const {
    const uint32_t* starts =
        &starts_[group.first_start + static_cast<size_t>(row) * static_cast<size_t>(columns_)];
    const int first = std::max(cell(x.low, 0), 0), last = std::min(cell(x.high, 0), columns_ - 1);
    if (last < first) return {};
    return {starts[first], starts[last + 1]};
  }
  /// 1 / reference depth.
  float inverse_reference() const { return inverse_reference_; }
  /// Positions of all lines at a depth.
  std::array<Range, 2> extent(float depth) const;
  /// Largest depth so far over all lines; infinity when a line has met nothing.
  float max_depth() const;

  TileWinner winner(size_t slot) const { return {chunk_[place_[slot]], primitive_[place_[slot]]}; }
  void trace_all();

  /// Memory for this number of lines.
  static size_t bytes(size_t lines);

 private:
  int cell(float position, size_t axis) const;

  std::vector<float> ax_, ay_, bx_, by_, time_, depth_;
  std::vector<uint32_t> chunk_, primitive_, random_;
  std::vector<uint32_t> place_;  // by slot
  std::vector<uint32_t> starts_, keys_;
  std::vector<Group> groups_;
  float low_[2] = {0, 0}, size_[2] = {1, 1}, inverse_size_[2] = {1, 1};
  float inverse_reference_ = 0;
  int rows_ = 1, columns_ = 1;
  bool has_lens_ = false;
  Range slopes_[2];  // of all lines
};

}  // namespace pelage
