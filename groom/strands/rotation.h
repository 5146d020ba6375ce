// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cmath>

#include "base/vector.h"

namespace pelage {

/// Computes the sine and cosine of `turns` full turns, with an error of at most 4e-6. Uses plain arithmetic,
/// so that loops over strands vectorise.
inline void sincos_turns(float turns, float& sine, float& cosine) {
  const auto sine_of_quarter = [](float y) {  // |y| <= 1/4 turn: Taylor series to the 9th power
    const float a = 6.28318531f * y;
    const float z = a * a;
    return a * (1.0f + z * (-1.0f / 6 + z * (1.0f / 120 + z * (-1.0f / 5040 + z * (1.0f / 362880)))));
  };
  const float x = turns - std::floor(turns + 0.5f);  // [-1/2, 1/2]
  const float magnitude = std::fabs(x);
  cosine = sine_of_quarter(0.25f - magnitude);
  const float folded = magnitude > 0.25f ? 0.5f - magnitude : magnitude;
  sine = std::copysign(sine_of_quarter(folded), x);
}

/// Returns the unit vector along `v`, or `fallback` if `v` is too short to have a direction.
inline V3f normalised_or(const V3f& v, const V3f& fallback) {
  const float length2 = v.dot(v);
  return length2 > 1e-24f ? v * (1.0f / std::sqrt(length2)) : fallback;
}

/// Returns an arbitrary unit vector perpendicular to the unit vector `n`.
inline V3f any_perpendicular(const V3f& n) {
  const V3f axis = std::fabs(n.x) < 0.6f ? V3f(1, 0, 0) : V3f(0, 1, 0);
  return normalised_or(axis - n * n.dot(axis), V3f(0, 0, 1));
}

/// A rotation about a unit axis.
struct Rotation {
  V3f axis{0, 0, 1};
  float angle = 0;  ///< radians

  V3f apply(const V3f& v) const { return apply(v, angle); }
  V3f apply(const V3f& v, float by) const {
    const float s = std::sin(by), c = std::cos(by);
    return v * c + axis.cross(v) * s + axis * (axis.dot(v) * (1.0f - c));
  }
};

/// Returns the smallest rotation from the unit vector `from` to the unit vector `to`. If they are opposite,
/// its axis is `if_opposite`, a unit vector perpendicular to `from`.
inline Rotation rotation_between(const V3f& from, const V3f& to, const V3f& if_opposite) {
  const V3f cross = from.cross(to);
  const float sine = cross.length();
  const float cosine = from.dot(to);
  if (sine < 1e-6f) {
    return cosine > 0 ? Rotation{if_opposite, 0} : Rotation{if_opposite, 3.14159265f};
  }
  return {cross * (1.0f / sine), std::atan2(sine, cosine)};
}

}  // namespace pelage
