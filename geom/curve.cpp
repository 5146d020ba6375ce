// SPDX-License-Identifier: Apache-2.0
#include "geom/curve.h"

#include <algorithm>
#include <cmath>

namespace pelage {
namespace {

/// Position and radius of one control point.
struct Knot {
  V3f p;
  float r;
  friend Knot operator+(const Knot& a, const Knot& b) { return {a.p + b.p, a.r + b.r}; }
  friend Knot operator-(const Knot& a, const Knot& b) { return {a.p - b.p, a.r - b.r}; }
  friend Knot operator*(float s, const Knot& a) { return {s * a.p, s * a.r}; }
};

/// A time within the shutter: between the keys `key` and `key + 1`, or at `key` when `fraction` is 0.
struct KeyTime {
  int key = 0;
  float fraction = 0;
};

KeyTime key_time(const Strands& strands, float time) {
  const float scaled = std::clamp(time, 0.0f, 1.0f) * static_cast<float>(strands.motion_keys() - 1);
  const int key = std::min(static_cast<int>(scaled), std::max(strands.motion_keys() - 2, 0));
  return {key, scaled - static_cast<float>(key)};
}

Knot knot(const Strands& strands, size_t index, KeyTime time) {
  const Knot a{strands.point(index, time.key), strands.radius(index, time.key)};
  if (time.fraction == 0) return a;
  const Knot b{strands.point(index, time.key + 1), strands.radius(index, time.key + 1)};
  return (1.0f - time.fraction) * a + time.fraction * b;
}

CubicSegment cubic(const Knot& a, const Knot& b, const Knot& c, const Knot& d) {
  return {{a.p, b.p, c.p, d.p}, {a.r, b.r, c.r, d.r}};
}

constexpr float kThird = 1.0f / 3.0f;
constexpr float kSixth = 1.0f / 6.0f;

/// Points `first` .. `first + 3` of the strand's uniform B-spline; -1 and `count` are phantom points.
CubicSegment b_spline_segment(const Strands& strands, size_t strand, int first, KeyTime time) {
  const size_t base = strands.first_point(strand);
  const int last = static_cast<int>(strands.strand_points(strand)) - 1;
  const auto at = [&](int i) { return knot(strands, base + static_cast<size_t>(i), time); };
  const Knot p1 = at(first + 1);
  const Knot p2 = at(first + 2);
  const Knot b1 = kThird * (2.0f * p1 + p2);
  const Knot b2 = kThird * (p1 + 2.0f * p2);
  // At a pinned end the phantom point makes the curve interpolate the end point; set exactly here.
  const Knot b0 = first < 0 ? p1 : 0.5f * (kThird * (at(first) + 2.0f * p1) + b1);
  const Knot b3 = first + 3 > last ? p2 : 0.5f * (b2 + kThird * (2.0f * p2 + at(first + 3)));
  return cubic(b0, b1, b2, b3);
}

CubicSegment catmull_rom_segment(const Strands& strands, size_t strand, int segment, KeyTime time) {
  const size_t base = strands.first_point(strand);
  const int last = static_cast<int>(strands.strand_points(strand)) - 1;
  const auto at = [&](int i) { return knot(strands, base + static_cast<size_t>(i), time); };
  const Knot p1 = at(segment);
  const Knot p2 = at(segment + 1);
  const Knot p0 = segment == 0 ? 2.0f * p1 - p2 : at(segment - 1);
  const Knot p3 = segment + 2 > last ? 2.0f * p2 - p1 : at(segment + 2);
  return cubic(p1, p1 + kSixth * (p2 - p0), p2 - kSixth * (p3 - p1), p2);
}

CubicSegment segment_of(const Strands& strands, size_t strand, uint32_t segment, KeyTime time) {
  const int s = static_cast<int>(segment);
  switch (strands.basis()) {
    case CurveBasis::kPinnedBSpline:
      return b_spline_segment(strands, strand, s - 1, time);
    case CurveBasis::kBSpline:
      return b_spline_segment(strands, strand, s, time);
    case CurveBasis::kCatmullRom:
      return catmull_rom_segment(strands, strand, s, time);
    case CurveBasis::kBezier: {
      const size_t first = strands.first_point(strand) + size_t(3) * segment;
      return cubic(knot(strands, first, time), knot(strands, first + 1, time), knot(strands, first + 2, time),
                   knot(strands, first + 3, time));
    }
    case CurveBasis::kLinear:
      break;
  }
  const size_t index = strands.first_point(strand) + segment;
  const Knot a = knot(strands, index, time);
  const Knot b = knot(strands, index + 1, time);
  return cubic(a, kThird * (2.0f * a + b), kThird * (a + 2.0f * b), b);
}

}  // namespace

CubicSegment bezier_segment(const Strands& strands, size_t strand, uint32_t segment, int key) {
  return segment_of(strands, strand, segment, {key, 0.0f});
}

CubicSegment bezier_segment_at(const Strands& strands, size_t strand, uint32_t segment, float time) {
  return segment_of(strands, strand, segment, key_time(strands, time));
}

V3f curve_position(const CubicSegment& s, float t) {
  const float u = 1.0f - t;
  return (u * u * u) * s.p[0] + (3.0f * u * u * t) * s.p[1] + (3.0f * u * t * t) * s.p[2] +
         (t * t * t) * s.p[3];
}

V3f curve_tangent(const CubicSegment& s, float t) {
  const float u = 1.0f - t;
  const V3f a = s.p[1] - s.p[0];
  const V3f b = s.p[2] - s.p[1];
  const V3f c = s.p[3] - s.p[2];
  const V3f first = 3.0f * ((u * u) * a + (2.0f * u * t) * b + (t * t) * c);
  // A derivative that is lost in rounding relative to the polygon's length has no meaningful direction.
  const float scale2 = a.length2() + b.length2() + c.length2();
  const float vanishing2 = 1e-10f * scale2;
  if (first.length2() > vanishing2) return first;
  const V3f second = 6.0f * (u * (b - a) + t * (c - b));
  if (second.length2() > vanishing2) return t < 0.5f ? second : -second;
  const V3f third = (c - b) - (b - a);
  return scale2 > 0 ? third : V3f(0, 1, 0);
}

float curve_radius(const CubicSegment& s, float t) {
  const float u = 1.0f - t;
  const float r =
      u * u * u * s.r[0] + 3.0f * u * u * t * s.r[1] + 3.0f * u * t * t * s.r[2] + t * t * t * s.r[3];
  return std::max(r, 0.0f);
}

CubicSegment segment_at(const Strands& strands, size_t strand, float v, float time, float& t) {
  const uint32_t count = segment_count(strands.basis(), strands.strand_points(strand));
  const float scaled = std::clamp(v, 0.0f, 1.0f) * static_cast<float>(count);
  const uint32_t segment = std::min(static_cast<uint32_t>(scaled), count - 1);
  t = scaled - static_cast<float>(segment);
  return bezier_segment_at(strands, strand, segment, time);
}

}  // namespace pelage
