// SPDX-License-Identifier: Apache-2.0
#include "render/light/sphere_light.h"

#include <algorithm>
#include <cmath>

#include "render/sampling/warp.h"

namespace pelage {

namespace {

/// 1 - cos m of the cone that a sphere subtends, with sin^2 m = r^2 / D^2; without cancellation for small
/// angles.
float cone_height(float sin2) { return sin2 / (1.0f + std::sqrt(1.0f - sin2)); }

}  // namespace

SphereLight::SphereLight(std::string name, const V3f& center, float radius, const Rgb& radiance, bool visible)
    : Light(std::move(name), visible),
      center_(center),
      radius_(radius),
      radiance_(radiance),
      luminance_(luminance(radiance)) {}

float SphereLight::solid_angle(const V3f& from) const {
  const V3f to_center = center_ - from;
  const float distance2 = to_center.dot(to_center);
  if (!(distance2 > radius_ * radius_)) return 4.0f * kPi;
  return 2.0f * kPi * cone_height(radius_ * radius_ / distance2);
}

std::optional<LightSample> SphereLight::sample(const V3f& from, const V2f& u) const {
  const V3f to_center = center_ - from;
  const float distance2 = to_center.dot(to_center);
  if (!(distance2 > radius_ * radius_)) {
    const V3f direction = uniform_direction(u);
    const std::optional<LightHit> hit = intersect(from, direction);
    if (!hit) return std::nullopt;
    return LightSample{direction, hit->distance, radiance_, 1.0f / (4.0f * kPi), hit->normal};
  }
  const float height = cone_height(radius_ * radius_ / distance2);
  const float drop = u.x * height;  // 1 - cos of the angle to the axis
  const float sin2 = drop * (2.0f - drop);
  const float sine = std::sqrt(sin2);
  const float center_distance = std::sqrt(distance2);
  const V3f axis = to_center * (1.0f / center_distance);
  V3f x, y;
  complete_frame(axis, x, y);
  const float phi = 2.0f * kPi * u.y;
  const V3f direction = (1.0f - drop) * axis + (sine * std::cos(phi)) * x + (sine * std::sin(phi)) * y;
  const float half_chord = std::sqrt(std::max(0.0f, radius_ * radius_ - distance2 * sin2));
  const float distance = center_distance * (1.0f - drop) - half_chord;
  return LightSample{direction, distance, radiance_, 1.0f / (2.0f * kPi * height),
                     (distance * direction - to_center).normalized()};
}

float SphereLight::pdf(const V3f& from, const V3f& direction) const {
  return intersect(from, direction) ? 1.0f / solid_angle(from) : 0.0f;
}

std::optional<LightHit> SphereLight::intersect(const V3f& from, const V3f& direction) const {
  const V3f to_center = center_ - from;
  const float along = to_center.dot(direction);
  const bool inside = !(to_center.dot(to_center) > radius_ * radius_);
  if (!inside && !(along > 0.0f)) return std::nullopt;
  // Distance of the centre from the ray as the length of a vector, because b^2 - 4ac would cancel for distant
  // spheres.
  const V3f beside = to_center - along * direction;
  const float chord2 = radius_ * radius_ - beside.dot(beside);
  if (!(chord2 >= 0.0f)) {
    // Rounding may place a point inside the sphere beside its own chord.
    if (!inside) return std::nullopt;
    return LightHit{std::max(0.0f, along), radiance_, -beside.normalized()};
  }
  const float half_chord = std::sqrt(chord2);
  const float distance = std::max(0.0f, inside ? along + half_chord : along - half_chord);
  return LightHit{distance, radiance_, (distance * direction - to_center).normalized()};
}

float SphereLight::importance(const V3f& from) const { return luminance_ * solid_angle(from); }

}  // namespace pelage
