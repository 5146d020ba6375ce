// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

#include "geom/strands.h"
#include "procedurals/chunk_bounds.h"

namespace pelage {

/// One segment of one strand of a batch.
struct SegmentPlace {
  uint32_t strand = 0;
  uint32_t segment = 0;
};

/// How a batch is divided into parts and cells. The tree over all chunks has the boxes of parts. The boxes of
/// cells are the fine boxes of a chunk, which are known before the chunk is grown. In a test with random rays
/// through leaves of 5,600 segments, 30 % of the rays hit hair and 86 % hit a part. Cells of 64, 32 or 16
/// segments are hit by 72, 69 or 67 % of the rays and take 0.7, 1.4 or 2.8 KB per leaf.
struct SegmentDivision {
  size_t cell_segments = 32;  ///< max per cell
  size_t part_cells = 16;     ///< a power of 2
};

/// The segments of a batch in groups of neighbours. The groups ignore strands: the box of pieces of many
/// strands is much smaller than the box of a few whole strands. Strands with consecutive indices are not
/// neighbours either: a batch is stored by priority, so every prefix of the batch is spread over the whole
/// leaf.
///
/// The batch is divided into cells with about the same number of segments, by recursive halving at the median
/// along the longest axis; the position of a segment is the centre of its box at the first motion key. Parts
/// are runs of cells. In every left half, the number of cells is a power of 2, so every aligned run of 2^n
/// cells is also a group of neighbours.
class SegmentParts {
 public:
  explicit SegmentParts(const Strands& strands, const SegmentDivision& division = {});

  /// Cells and parts are never empty; a batch without segments has none.
  size_t cell_count() const { return cells_; }
  size_t part_count() const { return (cells_ + division_.part_cells - 1) / division_.part_cells; }
  std::span<const SegmentPlace> cell(size_t c) const { return segments(c, c + 1); }
  std::span<const SegmentPlace> part(size_t p) const {
    return segments(p * division_.part_cells, std::min((p + 1) * division_.part_cells, cells_));
  }
  /// The exact box of every part, and fine boxes of the cells. With one key, a box contains the part at all
  /// motion keys. With two keys, the boxes are at the first and the last motion key, enlarged where the
  /// interpolated box would not contain the part at a motion key in between.
  ChunkBounds exact_bounds(int keys) const;
  /// Max memory of an instance, including exact_bounds().
  static size_t bytes_bound(size_t segments, size_t motion_keys);

 private:
  struct Item;

  std::span<const SegmentPlace> segments(size_t first_cell, size_t last_cell) const {
    return std::span(order_).subspan(begin_of(first_cell), begin_of(last_cell) - begin_of(first_cell));
  }
  /// Index of a cell's first segment in order_.
  size_t begin_of(size_t cell) const { return cell * order_.size() / cells_; }
  void divide(std::span<Item> items, size_t first_cell, size_t last_cell);
  Box3f exact_box(size_t part, std::span<const int> keys) const;
  /// At motion key `key`.
  const Box3f& hull(size_t key, size_t in_order) const { return hulls_[key * order_.size() + in_order]; }

  const Strands& strands_;
  const SegmentDivision division_;
  size_t cells_ = 0;
  std::vector<SegmentPlace> order_;
  std::vector<Box3f> hulls_;  // of each segment in order_, key by key
};

/// Enlarges the boxes at shutter open and close so that the box interpolated linearly between them contains
/// `boxes`. `boxes` are at evenly spaced times from shutter open to close.
void interpolate_boxes(std::span<const Box3f> boxes, Box3f& open, Box3f& close);

}  // namespace pelage
