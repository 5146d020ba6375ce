// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <limits>
#include <vector>

#include "base/parallel.h"

namespace pelage {

/// A vector in the picture, in pixels: x right, y down.
struct Flow {
  float x = 0, y = 0;
  bool operator==(const Flow&) const = default;
};

/// Criteria for two neighbours to belong to one surface.
struct LinkLimits {
  float largest_time = 1;    ///< max magnitude of all times that the field will be warped to
  float tear = 1.5f;         ///< max change of the distance of neighbours, in pixels
  float depth_step = 0.05f;  ///< max step of 1 / depth between neighbours, relative to 1 / depth of the
                             ///< nearer one
};

/// Motion and depth of every pixel of a picture, and which neighbours belong to the same surface (the
/// decisions of the motion-gradient image). Thread safety: immutable once made.
///
/// Memory: kBytesPerPixel per pixel, and one more byte while it is made.
class FlowField {
 public:
  static constexpr size_t kBytesPerPixel = 13;
  /// Max width and height: a pixel's position is a pair of 16-bit numbers.
  static constexpr int kLargestSide = 65535;
  /// Vectors are clamped to this length: enough to leave any picture.
  static constexpr float kLongest = 1 << 18;
  static Flow cut(Flow m) {
    return {std::clamp(m.x, -kLongest, kLongest), std::clamp(m.y, -kLongest, kLongest)};
  }

  /// `motion`, `depth`: width * height, rows from the top. Non-finite vectors count as zero. Depth is a
  /// distance; its sign is ignored, and invalid values (zero, infinity, NaN) are infinitely far away. Pixels
  /// for which `is_thin` is not 0 get no seams.
  FlowField(int width, int height, std::vector<Flow> motion, std::vector<float> depth,
            const LinkLimits& limits, const Workers& workers, const std::vector<uint8_t>* is_thin = nullptr);

  int width() const { return width_; }
  int height() const { return height_; }
  Flow motion(int x, int y) const { return motion_[at(x, y)]; }
  float depth(int x, int y) const { return depth_[at(x, y)]; }
  bool linked_right(int x, int y) const { return links_[at(x, y)] & kRight; }
  bool linked_down(int x, int y) const { return links_[at(x, y)] & kDown; }

  /// Whether a neighbour on another, nearer surface may separate from this pixel. False if either pixel is
  /// infinitely far away, because an empty pixel or a sky does not end where it is occluded. Also false if
  /// this pixel is thin, because the background is visible beside a strand.
  bool has_seam(int x, int y) const { return links_[at(x, y)] & kSeam; }
  /// Whether the first of two neighbours is farther away. If both are equally far, the later neighbour counts
  /// as farther.
  bool is_behind(int x, int y, int other_x, int other_y) const;

  /// Whether all four corners move like the pixel, so that it stays a unit square.
  bool is_rigid(int x, int y) const { return links_[at(x, y)] & kRigid; }
  /// Motion of the pixel's corner (right, bottom: 0 or 1): of the four pixels that meet at the corner, the
  /// mean over those on the same surface. All these pixels get the same bits, so that a surface has no
  /// cracks.
  Flow corner(int x, int y, int right, int bottom) const {
    const int left = x + right - 1, top = y + bottom - 1;
    if (left < 0 || top < 0 || !(links_[at(left, top)] & kFour)) return torn_corner(x, y, right, bottom);
    const Flow* a = &motion_[at(left, top)];
    return mean_of_four(a[0], a[1], a[width_], a[width_ + 1]);
  }

  /// Pixels whose motion is bounded together.
  struct Block {
    int x0, y0, x1, y1;
    Flow low{0, 0}, high{0, 0};  ///< bounds of the vectors in the block
  };
  static constexpr int kBlockWidth = 64, kBlockHeight = 8;
  /// Row by row.
  const std::vector<Block>& blocks() const { return blocks_; }
  /// One block for each row of blocks; it bounds all blocks of the row.
  const std::vector<Block>& block_rows() const { return block_rows_; }
  int blocks_across() const { return (width_ + kBlockWidth - 1) / kBlockWidth; }
  /// Max distance by which a corner may move farther than every pixel of its block.
  float slack() const { return slack_; }
  /// Bounds of all vectors.
  Flow low() const { return low_; }
  Flow high() const { return high_; }

 private:
  static constexpr uint8_t kRight = 1, kDown = 2, kRigid = 4;
  /// The four pixels of which this is the upper left one belong to one surface.
  static constexpr uint8_t kFour = 8;
  static constexpr uint8_t kSeam = 16;
  /// Computed from differences to the first: the mean of equal vectors is exact.
  static Flow mean_of_four(Flow a, Flow b, Flow c, Flow d) {
    return {a.x + ((b.x - a.x) + (c.x - a.x) + (d.x - a.x)) * 0.25f,
            a.y + ((b.y - a.y) + (c.y - a.y) + (d.y - a.y)) * 0.25f};
  }
  size_t at(int x, int y) const { return static_cast<size_t>(y) * static_cast<size_t>(width_) + x; }
  bool is_linked(size_t a, size_t b, const LinkLimits& limits) const;
  void clean(size_t pixel);
  void link_row(int y, const LinkLimits& limits);
  bool are_four_linked(int x, int y) const;
  Flow torn_corner(int x, int y, int right, int bottom) const;
  bool has_own_corners(int x, int y) const;
  bool is_occluded(int x, int y) const;
  void bound_blocks();

  int width_, height_;
  std::vector<Flow> motion_;
  std::vector<float> depth_;
  std::vector<uint8_t> links_;
  std::vector<Block> blocks_, block_rows_;
  Flow low_, high_;
  float slack_;
};

}  // namespace pelage
