// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <algorithm>
#include <array>
#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

#include "render/raster/depth_grid.h"
#include "render/raster/range.h"
#include "render/raster/tile_line.h"

namespace pelage {

/// The lines of sight of all camera samples of a tile, sorted for rasterising, each with the primitive that
/// it meets first, among those drawn so far.
///
/// Lines are sorted into groups of similar lens position. Within a group, they are sorted into a
/// grid of cells, row by row. The lines that a shape may meet are therefore a few runs of consecutive lines.
/// The cell of a line follows from the position of the line at the reference depth, divided by this depth.
class TileLines {
 public:
  /// Lines of similar lens position.
  struct Group {
    Range a[2];                ///< range of TileLine::a, by axis
    Range time;                ///< range of TileLine::time
    uint32_t first_start = 0;  ///< index in starts_
  };
  /// Consecutive lines.
  struct Run {
    uint32_t begin = 0, end = 0;
  };
  /// The arrays that kernels read and write, each followed by kPadding unused elements.
  struct Arrays {
    float *ax, *ay, *bx, *by, *time, *depth;
    uint32_t *chunk, *primitive, *random;
  };
  static constexpr size_t kPadding = 16;
  static constexpr int kMaxRows = 48, kMaxColumns = 2 * kMaxRows;

  /// Sorts lines. A slot is the index of a line in `lines`. `reference`: a depth at which the lines of a
  /// pixel are close together; may be infinity. `lens_parts`: how often the range of `a` is divided along
  /// each axis. Each part has a group. If there are few lines, there may be fewer groups.
  void assign(std::span<const TileLine> lines, float reference, int lens_parts = 1);
  static constexpr int kMaxLensParts = 8;
  /// Returns in how many parts to divide the range of `a` for shapes in this range of depths. More parts find
  /// fewer lines for a shape that is out of focus, but each part takes time.
  int lens_parts(const Range& depths) const;

  size_t size() const { return place_.size(); }
  std::span<const Group> groups() const { return groups_; }
  bool has_lens() const { return has_lens_; }
  Arrays arrays();
  /// A range of rows of cells; empty if first > last.
  struct Rows {
    int first = 0, last = -1;
  };
  /// Returns the rows that a range of positions y overlaps.
  Rows rows(const Range& y) const {
    return {std::max(cell(y.low, 1), 0), std::min(cell(y.high, 1), rows_ - 1)};
  }
  /// Returns the range of positions y in a row.
  Range row_range(int row) const {
    return {low_[1] + static_cast<float>(row) * size_[1], low_[1] + static_cast<float>(row + 1) * size_[1]};
  }
  /// Returns the lines of a group in those cells of a row that a range of positions x overlaps.
  Run run(const Group& group, int row, const Range& x) const {
    const uint32_t* starts =
        &starts_[group.first_start + static_cast<size_t>(row) * static_cast<size_t>(columns_)];
    const int first = std::max(cell(x.low, 0), 0), last = std::min(cell(x.high, 0), columns_ - 1);
    if (last < first) return {};
    return {starts[first], starts[last + 1]};
  }
  /// Returns 1 / reference depth.
  float inverse_reference() const { return inverse_reference_; }
  /// Returns the range of x and the range of y of all lines at a depth.
  std::array<Range, 2> extent(float depth) const;
  /// Returns the range, by axis, of TileLine::a or b of all lines.
  const Range& offsets(size_t axis) const { return offsets_[axis]; }
  const Range& slopes(size_t axis) const { return slopes_[axis]; }
  /// Depths beyond which lines are occluded.
  const DepthGrid& grid() const { return grid_; }
  /// Updates grid().
  void update_grid() { grid_.update(depth_.data()); }

  /// Returns the primitive that the line of a slot meets first.
  TileWinner winner(size_t slot) const { return {chunk_[place_[slot]], primitive_[place_[slot]]}; }
  /// Makes every line a line that drawing cannot decide.
  void trace_all();
  /// Makes lines in this footprint lines that drawing cannot decide, unless they end before it.
  void trace(const ViewFootprint& footprint);

  /// Returns the max memory for this count of lines, in bytes.
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
  Range offsets_[2], slopes_[2];  // of all lines
  DepthGrid grid_;
};

}  // namespace pelage
