// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <algorithm>
#include <cmath>
#include <limits>
#include <vector>

#include "post/flow_field.h"
#include "post/work_buffer.h"

namespace pelage {

/// Maps pixels of the resulting picture to pixels of the field: without motion, pixel (x, y) of the picture
/// shows pixel (x + origin_x, y + origin_y) of the field, which may lie outside the field.
struct WarpTarget {
  int scale = 4;  ///< samples along each side of a pixel
  int origin_x = 0, origin_y = 0;
  /// Max width of seams, in pixels: wider gaps between two pixels that are neighbours in the field stay open.
  float longest_seam = 0;
};

/// Draws the pixels of a field, moved to a given time, into tiles of a picture. A pixel is a square whose
/// four corners move (FlowField::corner()). A sample shows the pixel if the centre of the sample lies inside
/// the moved pixel. Neighbours on one surface share their corners, so each sample near their common side
/// shows exactly one of them.
///
/// If two neighbours on different surfaces move apart, the farther pixel is extended to the nearer one. The
/// extension is called a seam. A seam is visible only at samples that show no pixel at a finite distance.
///
/// `Buffer` is WorkBuffer, or a class with the same members samples() and put(). Thread safety: const members
/// may be called from any thread, if each thread passes its own buffer.
class Warp {
 public:
  Warp(const FlowField& field, WarpTarget target) : field_(field), target_(target) {}

  /// Returns the blocks of the field whose pixels may reach `samples` at any time from `first_time` to
  /// `last_time`.
  std::vector<const FlowField::Block*> reaching(const PixelBox& samples, float first_time,
                                                float last_time) const;
  /// Returns whether pixels of the block may reach `samples` at one time.
  bool reaches(const FlowField::Block& block, const PixelBox& samples, float time) const {
    return reaches(block, samples, time, time);
  }

  /// Draws all pixels of a block, moved to `time`.
  template <class Buffer>
  void draw(const FlowField::Block& block, float time, Buffer& buffer) const {
    const Point margin = margin_at(std::abs(time));
    for (int y = block.y0; y < block.y1; ++y) {
      for (int x = block.x0; x < block.x1; ++x) draw_pixel(x, y, time, margin, buffer);
    }
  }
  /// Draws pixel (x, y) of the field, moved to `time`.
  template <class Buffer>
  void draw(int x, int y, float time, Buffer& buffer) const {
    draw_pixel(x, y, time, margin_at(std::abs(time)), buffer);
  }

  struct Times {
    float first, last;  ///< empty when last < first
  };
  /// Returns a range within -largest <= time <= largest that contains all such times at which pixel (x, y)
  /// may reach `samples`.
  Times times_near(int x, int y, float largest, const PixelBox& samples) const;

 private:
  struct Point {
    float x, y;
  };

  bool reaches(const FlowField::Block& block, const PixelBox& samples, float first, float last) const;
  /// Returns the max distance in x and y, in samples, between a moved pixel and the samples that it or its
  /// seams may cover, for times with an absolute value up to `time`. The moved pixel is the pixel's corner
  /// moved by the pixel's own vector. The distance includes the size of the pixel, the motion of its shared
  /// corners, and its seams.
  Point margin_at(float time) const {
    const auto scale = static_cast<float>(target_.scale);
    const float own = 2 + field_.slack() * time;
    const Point seam = seam_reach(time);
    return {scale * (own + seam.x), scale * (own + seam.y)};
  }
  template <class Buffer>
  void draw_pixel(int x, int y, float time, Point margin, Buffer& buffer) const {
    if (field_.is_rigid(x, y)) {
      draw_square(x, y, time, buffer);
    } else if (is_near(x, y, time, buffer.samples(), margin)) {
      draw_quad(x, y, time, buffer);
    }
    if (target_.longest_seam > 0 && field_.has_seam(x, y) && is_near(x, y, time, buffer.samples(), margin)) {
      draw_seams(x, y, time, buffer);
    }
  }
  /// Returns upper bounds of the width and height of a seam, in pixels, at times with an absolute value up to
  /// `time`. The range of all vectors of the field limits them.
  Point seam_reach(float time) const;

  /// Returns the position of corner (x, y) of the field, moved to `time`, in samples of the picture. The
  /// result is bit-identical for all pixels that share the corner.
  Point place(int x, int y, Flow motion, float time) const {
    const auto scale = static_cast<float>(target_.scale);
    return {scale * (static_cast<float>(x - target_.origin_x) + time * motion.x),
            scale * (static_cast<float>(y - target_.origin_y) + time * motion.y)};
  }
  bool is_near(int x, int y, float time, const PixelBox& box, Point margin) const {
    const Point p = place(x, y, field_.motion(x, y), time);
    return p.x >= static_cast<float>(box.x0) - margin.x && p.x <= static_cast<float>(box.x1) + margin.x &&
           p.y >= static_cast<float>(box.y0) - margin.y && p.y <= static_cast<float>(box.y1) + margin.y;
  }
  /// Returns the smallest i >= low for which the centre of sample i, i + 0.5, is not before `edge`; at most
  /// `high`.
  static int first_sample(float edge, int low, int high) {
    const float at = std::min(std::max(edge - 0.5f, static_cast<float>(low)), static_cast<float>(high));
    const int below = static_cast<int>(at);  // tiles have no negative samples
    return below + (static_cast<float>(below) < at);
  }

  template <class Buffer>
  void draw_square(int x, int y, float time, Buffer& buffer) const {
    const PixelBox& box = buffer.samples();
    const Flow m = field_.motion(x, y);
    const Point from = place(x, y, m, time), to = place(x + 1, y + 1, m, time);
    const int x0 = first_sample(from.x, box.x0, box.x1), x1 = first_sample(to.x, box.x0, box.x1);
    if (x0 >= x1) return;
    const int y0 = first_sample(from.y, box.y0, box.y1), y1 = first_sample(to.y, box.y0, box.y1);
    const Sample sample(field_.depth(x, y), x, y);
    for (int row = y0; row < y1; ++row) buffer.put(row, x0, x1, sample);
  }

  /// A side of a quad. Starts at its upper end, so that both adjacent pixels compute the same crossings.
  struct Side {
    float y0, y1, x0, slope;
    Side(Point a, Point b) {
      if (b.y < a.y || (b.y == a.y && b.x < a.x)) std::swap(a, b);
      y0 = a.y;
      y1 = b.y;
      x0 = a.x;
      slope = b.y > a.y ? (b.x - a.x) / (b.y - a.y) : 0;
    }
    bool crosses(float y) const { return y0 <= y && y < y1; }
    float at(float y) const { return x0 + (y - y0) * slope; }
  };

  static float distance(Point a, Point b) { return std::max(std::abs(a.x - b.x), std::abs(a.y - b.y)); }
  Point corner(int x, int y, int right, int bottom, float time) const {
    return place(x + right, y + bottom, field_.corner(x, y, right, bottom), time);
  }

  template <class Buffer>
  void draw_quad(int x, int y, float time, Buffer& buffer) const {
    const Point p[4] = {corner(x, y, 0, 0, time), corner(x, y, 1, 0, time), corner(x, y, 0, 1, time),
                        corner(x, y, 1, 1, time)};
    fill_quad(p, Sample(field_.depth(x, y), x, y), buffer);
  }

  /// Draws the seams of a pixel with has_seam().
  template <class Buffer>
  void draw_seams(int x, int y, float time, Buffer& buffer) const {
    const Sample sample = Sample::seam(field_.depth(x, y), x, y);
    const auto exists = [&](int i, int j) {
      return i >= 0 && j >= 0 && i < field_.width() && j < field_.height();
    };
    for (const int side : {0, 1}) {
      const int step = 2 * side - 1;
      if (exists(x + step, y) && field_.is_behind(x, y, x + step, y)) {
        const Point p[4] = {corner(x, y, side, 0, time), corner(x + step, y, 1 - side, 0, time),
                            corner(x, y, side, 1, time), corner(x + step, y, 1 - side, 1, time)};
        draw_seam(p, sample, buffer);
      }
      if (exists(x, y + step) && field_.is_behind(x, y, x, y + step)) {
        const Point p[4] = {corner(x, y, 0, side, time), corner(x, y + step, 0, 1 - side, time),
                            corner(x, y, 1, side, time), corner(x, y + step, 1, 1 - side, time)};
        draw_seam(p, sample, buffer);
      }
    }
    // At a corner where seams meet, the farthest of the four pixels around the corner fills the gap between
    // them.
    for (int c = 0; c < 4; ++c) {
      const int left = x + (c & 1) - 1, top = y + (c >> 1) - 1;
      bool is_last = exists(left, top) && exists(left + 1, top + 1);
      for (int k = 0; k < 4 && is_last; ++k) {
        const int i = left + (k & 1), j = top + (k >> 1);
        is_last = (i == x && j == y) || field_.is_behind(x, y, i, j);
      }
      if (!is_last) continue;
      const Point p[4] = {corner(left, top, 1, 1, time), corner(left + 1, top, 0, 1, time),
                          corner(left, top + 1, 1, 0, time), corner(left + 1, top + 1, 0, 0, time)};
      const float down = std::max(distance(p[0], p[2]), distance(p[1], p[3]));
      if (down <= target_.longest_seam * static_cast<float>(target_.scale)) draw_seam(p, sample, buffer);
    }
  }

  template <class Buffer>
  void draw_seam(const Point (&p)[4], Sample sample, Buffer& buffer) const {
    const float longest = target_.longest_seam * static_cast<float>(target_.scale);
    const float apart = std::max(distance(p[0], p[1]), distance(p[2], p[3]));
    if (apart > 0 && apart <= longest) fill_quad(p, sample, buffer);
  }

  /// Draws a quad. `p`: left and right end of its upper side, then left and right end of its lower side.
  template <class Buffer>
  void fill_quad(const Point (&p)[4], Sample sample, Buffer& buffer) const {
    const PixelBox& box = buffer.samples();
    const float top = std::min(std::min(p[0].y, p[1].y), std::min(p[2].y, p[3].y));
    const float bottom = std::max(std::max(p[0].y, p[1].y), std::max(p[2].y, p[3].y));
    const int y0 = first_sample(top, box.y0, box.y1), y1 = first_sample(bottom, box.y0, box.y1);
    if (y0 >= y1) return;
    const float left = std::min(std::min(p[0].x, p[1].x), std::min(p[2].x, p[3].x));
    const float right = std::max(std::max(p[0].x, p[1].x), std::max(p[2].x, p[3].x));
    if (right <= static_cast<float>(box.x0) || left >= static_cast<float>(box.x1)) return;
    const Side sides[4] = {{p[0], p[1]}, {p[1], p[3]}, {p[2], p[3]}, {p[0], p[2]}};
    for (int row = y0; row < y1; ++row) {
      // From the leftmost to the rightmost crossing: exact for a convex quad, and without holes for a folded
      // one.
      const float centre = static_cast<float>(row) + 0.5f;
      float low = std::numeric_limits<float>::infinity(), high = -low;
      for (const Side& side : sides) {
        const bool crosses = side.crosses(centre);
        const float at = side.at(centre);
        low = crosses && at < low ? at : low;
        high = crosses && at > high ? at : high;
      }
      if (low < high) {
        buffer.put(row, first_sample(low, box.x0, box.x1), first_sample(high, box.x0, box.x1), sample);
      }
    }
  }

  const FlowField& field_;
  WarpTarget target_;
};

}  // namespace pelage
