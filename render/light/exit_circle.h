// SPDX-License-Identifier: Apache-2.0
// Tested in tests/render/light/scatter_point_test.cpp.
#pragma once

#include <algorithm>
#include <cmath>
#include <optional>

#include "base/vector.h"
#include "render/light/light.h"

namespace pelage {

/// The positions at which light leaves a fibre: a circle around `center`, perpendicular to the unit
/// `tangent`. Light leaves along lines at the distance h * radius from the axis. A smooth cylinder preserves
/// that distance through any number of internal reflections, and h has the sign of the fibre's frame. The
/// direction therefore determines the position on the circle: the hit itself for the mirror direction, the
/// far side for transmitted light.
///
/// A nearby light is sampled from this position, not from the axis. The directions differ by about radius /
/// distance.
struct ExitCircle {
  V3f center{0};
  V3f tangent{0};
  float radius = 0;  ///< 0: a point
  float h = 0;

  /// Position on the circle relative to its center, in radii, of light that leaves along `out`, a unit vector
  /// perpendicular to the tangent.
  V3f outside(const V3f& out) const { return cos_gamma() * out + h * tangent.cross(out); }
  float cos_gamma() const { return std::sqrt(std::max(0.0f, 1 - h * h)); }

  /// Origin of the line along `wi`.
  V3f origin(const V3f& wi) const {
    const V3f side = wi - wi.dot(tangent) * tangent;
    const float length2 = side.length2();
    if (radius == 0 || length2 < 1e-6f) return center;
    return center + radius * outside(side / std::sqrt(length2));
  }

  /// Converts a sample of a light seen from the center to a sample of the line that ends at the same point of
  /// the light: direction, distance, and density per solid angle of line directions. Empty when no line of
  /// the fibre reaches that side of the light.
  std::optional<LightSample> toward(const LightSample& seen) const {
    if (radius == 0 || std::isinf(seen.distance)) return seen;
    const V3f to = seen.distance * seen.direction;
    const float along = to.dot(tangent);
    const V3f across = to - along * tangent;
    const float rho2 = across.length2(), offset = h * radius;
    if (!(rho2 > radius * radius)) return std::nullopt;
    // The line intersects the cross-section through the light at `to` and is tangent to a circle of |offset|.
    const float from_nearest = std::sqrt(rho2 - offset * offset);
    const V3f out = (from_nearest * across - offset * tangent.cross(across)) / rho2;
    const float way = from_nearest - radius * cos_gamma();
    LightSample sample = seen;
    sample.direction = way * out + along * tangent;
    sample.distance = sample.direction.length();
    sample.direction /= sample.distance;
    const float cosine = sample.direction.dot(seen.normal);
    if (!(cosine * seen.direction.dot(seen.normal) > 0)) return std::nullopt;
    sample.pdf = line_pdf(seen, sample.direction, sample.distance);
    return sample;
  }

  /// Density of toward() for the line along `wi`, which intersects the light at `hit`.
  float pdf(const Light& light, const V3f& wi, const LightHit& hit) const {
    if (radius == 0 || std::isinf(hit.distance)) return light.pdf(center, wi);
    LightSample seen;
    seen.direction = origin(wi) + hit.distance * wi - center;
    seen.distance = seen.direction.length();
    seen.direction /= seen.distance;
    seen.normal = hit.normal;
    seen.pdf = light.pdf(center, seen.direction);
    return seen.pdf > 0 ? line_pdf(seen, wi, hit.distance) : 0.0f;
  }

 private:
  /// Density per solid angle of lines for `seen` from the center, and the line along `wi` that ends at the
  /// same point of the light after `distance`. Because the lines start on the circle, the area between two
  /// neighbouring lines is from_nearest / way times the area between lines that start at one point.
  float line_pdf(const LightSample& seen, const V3f& wi, float distance) const {
    const float way = distance * (wi - wi.dot(tangent) * tangent).length();
    if (!(way > 0)) return seen.pdf;
    const float spread = 1 + radius * cos_gamma() / way;
    const float by_area = std::abs(seen.direction.dot(seen.normal)) / (seen.distance * seen.distance);
    return seen.pdf * by_area * distance * distance * spread / std::abs(wi.dot(seen.normal));
  }
};

}  // namespace pelage
