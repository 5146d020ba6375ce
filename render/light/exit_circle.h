// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <algorithm>
#include <cmath>
#include <optional>

#include "base/vector.h"
#include "render/light/light.h"

namespace pelage {

/// The positions at which light leaves a fibre: a circle around `center`, perpendicular to the unit vector
/// `tangent`. Light leaves along straight lines whose distance from the axis is |h| * radius. A smooth
/// cylinder preserves this distance through any number of internal reflections. h has the sign that
/// FibreFrame defines. The direction of a line therefore determines the position on the circle where it
/// starts. This is the hit itself for the mirror direction, and a point on the far side for transmitted
/// light.
///
/// A nearby light is sampled from the position on the circle, not from the axis. The two directions to the
/// light differ by about radius / distance.
struct ExitCircle {
  V3f center{0};
  V3f tangent{0};
  float radius = 0;  ///< 0: light leaves at `center`
  float h = 0;       ///< offset of the lines from the axis, in radii: -1 to 1

  /// Returns the position on the circle, relative to its center and in radii, at which light leaves along
  /// `out`. `out`: a unit vector perpendicular to the tangent.
  V3f outside(const V3f& out) const { return cos_gamma() * out + h * tangent.cross(out); }
  /// Returns the cosine of the angle between a line, projected onto the plane of the circle, and the surface
  /// normal where the line starts.
  float cos_gamma() const { return std::sqrt(std::max(0.0f, 1 - h * h)); }

  /// Returns the position on the circle at which the line in direction `wi` starts.
  V3f origin(const V3f& wi) const {
    const V3f side = wi - wi.dot(tangent) * tangent;
    const float length2 = side.length2();
    if (radius == 0 || length2 < 1e-6f) return center;
    return center + radius * outside(side / std::sqrt(length2));
  }

  /// Converts a sample of a light as seen from the center. Returns the line that starts on the circle
  /// and ends at the same point of the light: its direction, its length, and its density per solid angle of
  /// line directions. Empty when no such line reaches this side of the light.
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

  /// Returns the density of toward() for the line in direction `wi`, which intersects the light at `hit`.
  float pdf(const Light& light, const V3f& wi, const LightHit& hit) const {
    if (radius == 0 || std::isinf(hit.distance)) return light.pdf_of_hit(center, wi, hit);
    LightSample seen;
    seen.direction = origin(wi) + hit.distance * wi - center;
    seen.distance = seen.direction.length();
    seen.direction /= seen.distance;
    seen.normal = hit.normal;
    seen.pdf = light.pdf(center, seen.direction);
    return seen.pdf > 0 ? line_pdf(seen, wi, hit.distance) : 0.0f;
  }

 private:
  /// Returns the density, per solid angle of line directions, of the line in direction `wi` that ends after
  /// `distance`. `seen`: the sample from the center with the same point of the light. Lines start on the
  /// circle, not at one point. The area of the light between neighbouring lines is therefore larger by the
  /// factor 1 + radius * cos_gamma() / way, where `way` is the length of the line projected onto the plane of
  /// the circle.
  float line_pdf(const LightSample& seen, const V3f& wi, float distance) const {
    const float way = distance * (wi - wi.dot(tangent) * tangent).length();
    if (!(way > 0)) return seen.pdf;
    const float spread = 1 + radius * cos_gamma() / way;
    const float by_area = std::abs(seen.direction.dot(seen.normal)) / (seen.distance * seen.distance);
    return seen.pdf * by_area * distance * distance * spread / std::abs(wi.dot(seen.normal));
  }
};

}  // namespace pelage
