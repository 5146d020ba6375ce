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

/// Two neighbouring pixels belong to one surface if they fulfil these criteria.
struct LinkLimits {
  float largest_time = 1;    ///< max absolute value of all times to which the field will be warped
  float tear = 1.5f;         ///< max change of the distance between two neighbours until that time, in pixels
  float depth_step = 0.05f;  ///< max difference of 1 / depth of two neighbours, as a fraction of 1 / depth of
                             ///< the nearer one
};

/// Motion and depth of every pixel of a picture. Also stores which neighbouring pixels belong to the same
/// surface. This is the information of Pixmotor's motion-gradient image. Neighbours on one surface are called
/// linked. Thread safety: immutable once constructed, so any thread may use it.
///
/// Memory: kBytesPerPixel bytes per pixel, and one more byte per pixel in the constructor.
class FlowField {
 public:
  static constexpr size_t kBytesPerPixel = 13;
  /// Max width and height, because Sample stores the position of a pixel in two 16-bit numbers.
  static constexpr int kLargestSide = 65535;
  /// Max absolute value of x and y of a vector, in pixels: enough to leave any picture.
  static constexpr float kLongest = 1 << 18;
  /// Clamps x and y of a vector to kLongest.
  static Flow cut(Flow m) {
    return {std::clamp(m.x, -kLongest, kLongest), std::clamp(m.y, -kLongest, kLongest)};
  }

  /// `motion`, `depth`: width * height values, rows from the top. Non-finite vectors count as zero. Depth is
  /// a distance, whose sign is ignored; pixels with a depth of zero, infinity or NaN are infinitely far away.
  /// `is_thin`, if not null: one value per pixel; pixels with a value other than 0 have no seams
  /// (has_seam()).
  FlowField(int width, int height, std::vector<Flow> motion, std::vector<float> depth,
            const LinkLimits& limits, const Workers& workers, const std::vector<uint8_t>* is_thin = nullptr);

  int width() const { return width_; }
  int height() const { return height_; }
  Flow motion(int x, int y) const { return motion_[at(x, y)]; }
  float depth(int x, int y) const { return depth_[at(x, y)]; }
  /// Whether the pixel and its right neighbour belong to the same surface.
  bool linked_right(int x, int y) const { return links_[at(x, y)] & kRight; }
  /// Whether the pixel and the neighbour below it belong to the same surface.
  bool linked_down(int x, int y) const { return links_[at(x, y)] & kDown; }

  /// Returns whether this pixel may need a seam (class Warp), because a neighbour belongs to a nearer
  /// surface, which may separate from this pixel. Returns false if this pixel is infinitely far away, because
  /// a sky does not end where a surface occludes it. Also returns false if this pixel is thin, because the
  /// background is visible beside a strand.
  bool has_seam(int x, int y) const { return links_[at(x, y)] & kSeam; }
  /// Returns whether pixel (x, y) is farther away than the other pixel. If both are equally far, the pixel
  /// that comes later in row order counts as farther.
  bool is_behind(int x, int y, int other_x, int other_y) const;

  /// Whether all four corners have the same motion as the pixel, so that the pixel stays a unit square.
  bool is_rigid(int x, int y) const { return links_[at(x, y)] & kRigid; }
  /// Returns the motion of a corner of a pixel. `right`, `bottom`: 0 or 1. Four pixels meet at the corner;
  /// the motion is the mean over those that are linked with this pixel, directly or through the others. The
  /// result is bit-identical for all these pixels, so a surface has no cracks.
  Flow corner(int x, int y, int right, int bottom) const {
    const int left = x + right - 1, top = y + bottom - 1;
    if (left < 0 || top < 0 || !(links_[at(left, top)] & kFour)) return torn_corner(x, y, right, bottom);
    const Flow* a = &motion_[at(left, top)];
    return mean_of_four(a[0], a[1], a[width_], a[width_ + 1]);
  }

  /// A rectangle of pixels with bounds of their motion. Contains pixels x0 <= x < x1, y0 <= y < y1.
  struct Block {
    int x0, y0, x1, y1;
    Flow low{0, 0}, high{0, 0};  ///< bounds of the vectors in the block
  };
  static constexpr int kBlockWidth = 64, kBlockHeight = 8;
  /// All blocks, row by row from the top.
  const std::vector<Block>& blocks() const { return blocks_; }
  /// For each row of blocks, one block that contains all of them.
  const std::vector<Block>& block_rows() const { return block_rows_; }
  int blocks_across() const { return (width_ + kBlockWidth - 1) / kBlockWidth; }
  /// Max distance, in pixels per unit of time, between the motion of a corner and the motion of its pixel.
  float slack() const { return slack_; }
  /// Min and max of x and y over all vectors.
  Flow low() const { return low_; }
  Flow high() const { return high_; }

 private:
  static constexpr uint8_t kRight = 1, kDown = 2, kRigid = 4;
  /// This pixel, its right neighbour and the two pixels below them belong to one surface.
  static constexpr uint8_t kFour = 8;
  static constexpr uint8_t kSeam = 16;
  /// Returns the mean of four vectors. Adds differences from the first vector, so that the mean of equal
  /// vectors is exact.
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
