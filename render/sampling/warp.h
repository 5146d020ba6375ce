// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <algorithm>
#include <cmath>
#include <numbers>

#include "base/vector.h"

namespace pelage {

inline constexpr float kPi = std::numbers::pi_v<float>;
/// The largest float below 1.
inline constexpr float kBelowOne = 0x1.fffffep-1f;

/// Computes two unit vectors such that (first, second, n) is a right-handed orthonormal frame [Duff17]. `n`
/// must be a unit vector.
inline void complete_frame(const V3f& n, V3f& first, V3f& second) {
  const float sign = std::copysign(1.0f, n.z);
  const float a = -1.0f / (sign + n.z);
  const float b = n.x * n.y * a;
  first = {1.0f + sign * n.x * n.x * a, sign * b, -sign * n.x};
  second = {b, sign + n.y * n.y * a, -n.y};
}

/// Returns the unit vector at an angle to `axis` with the cosine `z`. Its azimuth is 2 pi `turn`, measured
/// from `x` towards `y`. The unit vectors x, y and axis must be orthogonal.
inline V3f polar_direction(const V3f& x, const V3f& y, const V3f& axis, float z, float turn) {
  const float r = std::sqrt(std::max(0.0f, (1.0f - z) * (1.0f + z)));
  const float phi = 2.0f * kPi * turn;
  return z * axis + (r * std::cos(phi)) * x + (r * std::sin(phi)) * y;
}

/// Maps `u` in [0, 1)^2 to a uniformly distributed direction, with density 1 / (4 pi) per solid angle.
inline V3f uniform_direction(const V2f& u) {
  return polar_direction({1, 0, 0}, {0, 1, 0}, {0, 0, 1}, 1.0f - 2.0f * u.x, u.y);
}

/// Maps `u` in [0, 1)^2 to a uniformly distributed point of the unit disk. Neighbouring points stay
/// neighbours [ShirleyChiu97].
inline V2f concentric_disk(const V2f& u) {
  const float x = 2.0f * u.x - 1.0f;
  const float y = 2.0f * u.y - 1.0f;
  if (x == 0.0f && y == 0.0f) return V2f(0);
  const bool wide = std::abs(x) > std::abs(y);
  const float r = wide ? x : y;
  const float phi = wide ? kPi / 4 * (y / x) : kPi / 2 - kPi / 4 * (x / y);
  return {r * std::cos(phi), r * std::sin(phi)};
}

}  // namespace pelage
