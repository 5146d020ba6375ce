// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <algorithm>
#include <cmath>

#include "base/vector.h"

namespace pelage {

/// Upper bound, but at least 0.1, of cos(theta_i) over the directions from a fibre with tangent `tangent`
/// into a ball of `radius` around `to_center`: cos(max(0, |theta_c| - theta_u)), with theta_c the inclination
/// of the centre and theta_u the ball's angular radius. 1 for the null tangent (no fibre, or one with known
/// lobes).
///
/// The bound applies to lobes that are uniform in azimuth and proportional to cos(theta_i): the diffuse ones
/// of cone-shell and Kajiya-Kay. Narrow lobes of a fibre seen at a slant do not follow it, nor do those about
/// shifted tangents; hence the floor.
inline float fibre_cosine_bound(const V3f& to_center, float radius, const V3f& tangent) {
  const float distance2 = to_center.dot(to_center);
  if (tangent == V3f(0) || !(distance2 > radius * radius)) return 1.0f;
  const float distance = std::sqrt(distance2);
  const float sin_center = std::min(1.0f, std::abs(to_center.dot(tangent)) / distance);
  const float sin_radius = radius / distance;
  if (sin_center <= sin_radius) return 1.0f;
  const float cos_center = std::sqrt((1.0f - sin_center) * (1.0f + sin_center));
  const float cos_radius = std::sqrt((1.0f - sin_radius) * (1.0f + sin_radius));
  return std::max(0.1f, cos_center * cos_radius + sin_center * sin_radius);
}

}  // namespace pelage
