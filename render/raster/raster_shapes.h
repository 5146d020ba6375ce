// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cmath>

#include "base/vector.h"

namespace pelage {

/// The part of the shutter between two motion keys. At time t, a shape that moves from a to b is at
/// a + f (b - a), where f = t * scale - first.
struct KeySpan {
  float scale = 0, first = 0;
  bool is_last = true;  ///< whether the span includes its end
};

/// A piece of a strand in a tile's frame: the cubic p + u d + u (1 - u) (q + (1/2 - u) c) for u in [0, 1],
/// with radius r + u dr.
struct RasterPiece {
  struct Curve {
    V3f p{0}, d{0}, q{0}, c{0};

    V3f end() const { return p + d; }
    /// Max distance from the chord. kCubic is the max of |u (1 - u) (1/2 - u)|.
    float bulge() const { return 0.25f * q.length() + kCubic * c.length(); }
    /// Max difference in depth between the curve and its chord at the same u.
    float depth_bulge() const { return 0.25f * std::abs(q.z) + kCubic * std::abs(c.z); }
    static constexpr float kCubic = 0.0482f;
  };
  /// Returns the curve at the second motion key.
  Curve after() const { return {at.p + motion.p, at.d + motion.d, at.q + motion.q, at.c + motion.c}; }

  Curve at;      ///< the curve at the first motion key
  Curve motion;  ///< the curve at the second motion key, minus `at`
  float r = 0, dr = 0;
  /// Range of u in which the nearest point of the piece must lie. It is clamped to [0, 1] afterwards.
  float low = 0, high = 0;
  float segment_u = 0, segment_du = 1;  ///< u of the segment = segment_u + u * segment_du
  bool moves = false;
};

/// A triangle in a tile's frame.
struct RasterTriangle {
  /// Corners at the first motion key.
  V3f corners[3] = {V3f(0), V3f(0), V3f(0)};
  V3f motion[3] = {V3f(0), V3f(0), V3f(0)};  ///< corners at the second motion key, minus `corners`
  bool moves = false;
};

}  // namespace pelage
