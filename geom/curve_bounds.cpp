// SPDX-License-Identifier: Apache-2.0
#include "geom/curve_bounds.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <vector>

#include "geom/four_lanes.h"

namespace pelage {
namespace {

// Points evaluated in float deviate from the exact curve by a few units in the last place of the largest
// coordinate. Boxes are enlarged by eight half units, so that those points are inside as well.
constexpr float kRounding = 0x1p-21f;

float largest(const CubicSegment& s, int axis) {
  float result = 0;
  for (int i = 0; i < 4; ++i) result = std::max(result, std::abs(s.p[i][axis]) + std::abs(s.r[i]));
  return result;
}

/// Largest value on [0, 1] of the cubic with Bezier coefficients b.
double cubic_maximum(double b0, double b1, double b2, double b3) {
  double best = std::max(b0, b3);
  if (std::max(b1, b2) <= best) return best;  // by the convex hull, an end is the max
  const double d0 = b1 - b0, d1 = b2 - b1, d2 = b3 - b2;
  // derivative / 3 = d0 (1-t)^2 + 2 d1 t (1-t) + d2 t^2 = a t^2 + 2 h t + d0
  const double a = d0 - 2 * d1 + d2;
  const double h = d1 - d0;
  const double discriminant = h * h - a * d0;
  if (discriminant < 0) return best;
  const double q = -(h + std::copysign(std::sqrt(discriminant), h));
  const auto consider = [&](double t) {
    if (!(t > 0 && t < 1)) return;
    const double u = 1 - t;
    best = std::max(best, u * u * u * b0 + 3 * u * t * (u * b1 + t * b2) + t * t * t * b3);
  };
  if (a != 0) consider(q / a);
  if (q != 0) consider(d0 / q);
  return best;
}

/// Exact upper end along `axis` of sign * centre + radius, where a negative interpolated radius counts as 0.
double exact_reach(const CubicSegment& s, int axis, double sign) {
  double p[4];
  bool has_negative = false;
  for (int i = 0; i < 4; ++i) {
    p[i] = sign * s.p[i][axis];
    has_negative |= s.r[i] < 0;
  }
  const double reach = cubic_maximum(p[0] + s.r[0], p[1] + s.r[1], p[2] + s.r[2], p[3] + s.r[3]);
  return has_negative ? std::max(reach, cubic_maximum(p[0], p[1], p[2], p[3])) : reach;
}

/// Enlarges `box` by the exact box of the segment. Skips the extrema if the hull is already inside.
void extend_exactly(Box3f& box, const CubicSegment& s) {
  for (int axis = 0; axis < 3; ++axis) {
    float low = s.p[0][axis], high = low;
    for (int i = 0; i < 4; ++i) {
      const float r = std::max(s.r[i], 0.0f);
      low = std::min(low, s.p[i][axis] - r);
      high = std::max(high, s.p[i][axis] + r);
    }
    const float slack = kRounding * largest(s, axis);
    if (high + slack > box.max[axis]) {
      box.max[axis] = std::max(box.max[axis], static_cast<float>(exact_reach(s, axis, 1)) + slack);
    }
    if (low - slack < box.min[axis]) {
      box.min[axis] = std::min(box.min[axis], static_cast<float>(-exact_reach(s, axis, -1)) - slack);
    }
  }
}

/// Whether the hull of the strand's points at all motion keys lies inside `box`. If so, the strand does too:
/// Bezier points of linear and B-spline segments, including pinned ends, are convex combinations of points of
/// the strand.
bool is_hull_inside(const Box3f& box, const Strands& strands, size_t strand) {
  if (strands.basis() == CurveBasis::kCatmullRom || box.isEmpty()) return false;
  float low[3], high[3];
  std::copy_n(&box.max[0], 3, low);
  std::copy_n(&box.min[0], 3, high);
  for (int key = 0; key < strands.motion_keys(); ++key) {
    const float* p = &strands.points(key)[size_t(strands.first_point(strand)) * 4];
    const float* end = p + size_t(strands.strand_points(strand)) * 4;
    for (; p != end; p += 4) {
      for (int axis = 0; axis < 3; ++axis) {
        low[axis] = std::min(low[axis], p[axis] - std::max(p[3], 0.0f));
        high[axis] = std::max(high[axis], p[axis] + std::max(p[3], 0.0f));
      }
    }
  }
  for (int axis = 0; axis < 3; ++axis) {
    const float slack = kRounding * std::max(std::abs(low[axis]), std::abs(high[axis]));
    if (!(low[axis] - slack >= box.min[axis] && high[axis] + slack <= box.max[axis])) return false;
  }
  return true;
}

/// The ends of the shutter and the keys between them: positions and radii are linear in between.
std::vector<float> extreme_times(int motion_keys, float open, float close) {
  std::vector<float> times{open};
  if (motion_keys < 2) return times;
  for (int k = 0; k < motion_keys; ++k) {
    const float time = static_cast<float>(k) / static_cast<float>(motion_keys - 1);
    if (time > open && time < close) times.push_back(time);
  }
  if (close > open) times.push_back(close);
  return times;
}

/// Enlarges `box` by the exact box of a strand at the given times.
void extend_exactly(Box3f& box, const Strands& strands, size_t strand, std::span<const float> times) {
  const uint32_t segments = segment_count(strands.basis(), strands.strand_points(strand));
  if (segments == 0 || is_hull_inside(box, strands, strand)) return;
  for (uint32_t segment = 0; segment < segments; ++segment) {
    for (float time : times) extend_exactly(box, bezier_segment_at(strands, strand, segment, time));
  }
}

}  // namespace

Box3f hull_bounds(const CubicSegment& s) {
  Box3f box;
  for (int i = 0; i < 4; ++i) {
    const V3f reach(std::max(s.r[i], 0.0f));
    box.extendBy(s.p[i] - reach);
    box.extendBy(s.p[i] + reach);
  }
  const V3f slack = kRounding * V3f(largest(s, 0), largest(s, 1), largest(s, 2));
  return {box.min - slack, box.max + slack};
}

void append_hull_bounds(const Strands& strands, size_t strand, int key, std::vector<Box3f>& boxes) {
  const uint32_t segments = segment_count(strands.basis(), strands.strand_points(strand));
  if (strands.basis() != CurveBasis::kPinnedBSpline) {
    for (uint32_t i = 0; i < segments; ++i) {
      boxes.push_back(hull_bounds(bezier_segment(strands, strand, i, key)));
    }
    return;
  }
  const float* p = &strands.points(key)[size_t(strands.first_point(strand)) * 4];
  const auto knot = [p](size_t i) { return Four{p[4 * i], p[4 * i + 1], p[4 * i + 2], p[4 * i + 3]}; };
  constexpr float kThird = 1.0f / 3.0f;
  // Neighbours share the Bezier point at their joint, the midpoint of the adjacent inner points.
  Four start = knot(0);
  for (uint32_t i = 0; i < segments; ++i) {
    const Four a = knot(i), b = knot(i + 1);
    const Four first = kThird * (2.0f * a + b), second = kThird * (a + 2.0f * b);
    const bool last = i + 1 == segments;
    const Four end = last ? b : 0.5f * (second + kThird * (2.0f * b + knot(i + 2)));
    Four low = four(std::numeric_limits<float>::infinity()), high = -low, size = four(0);
    for (const Four& at : {start, first, second, end}) {
      const Four reach = four(std::max(at[3], 0.0f));
      low = smaller(low, at - reach);
      high = larger(high, at + reach);
      size = larger(size, larger(at, -at) + four(std::abs(at[3])));
    }
    low -= four(kRounding) * size;
    high += four(kRounding) * size;
    boxes.emplace_back(V3f(low[0], low[1], low[2]), V3f(high[0], high[1], high[2]));
    start = end;
  }
}

Box3f exact_bounds(const CubicSegment& segment) {
  Box3f box;
  extend_exactly(box, segment);
  return box;
}

Box3f exact_bounds(const Strands& strands, float open, float close) {
  Box3f box;
  const std::vector<float> times = extreme_times(strands.motion_keys(), open, close);
  for (size_t strand = 0; strand < strands.strand_count(); ++strand) {
    extend_exactly(box, strands, strand, times);
  }
  return box;
}

Box3f exact_bounds(const Strands& strands, std::span<const uint32_t> some, float open, float close) {
  Box3f box;
  const std::vector<float> times = extreme_times(strands.motion_keys(), open, close);
  for (uint32_t strand : some) extend_exactly(box, strands, strand, times);
  return box;
}

}  // namespace pelage
