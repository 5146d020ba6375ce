// SPDX-License-Identifier: Apache-2.0
#include "render/light/disk_light.h"

#include <cmath>

#include "render/sampling/warp.h"

namespace pelage {

DiskLight::DiskLight(std::string name, const V3f& center, const V3f& normal, float radius,
                     const Rgb& radiance, bool visible, const SpreadGrid& grid)
    : Light(std::move(name), visible),
      center_(center),
      normal_(normal),
      radius_(radius),
      radiance_(radiance),
      grid_(grid) {
  complete_frame(normal_, x_, y_);
}

SphericalRectangle DiskLight::square(const V3f& from) const {
  const V3f to = center_ - from;
  return {to.dot(x_), to.dot(y_), to.dot(normal_), radius_, radius_};
}

/// Whether the distance to the disk is less than about seven radii.
bool DiskLight::is_near(const SphericalRectangle& square) { return square.solid_angle() > 0.08; }

std::optional<LightSample> DiskLight::sample(const V3f& from, const V2f& u) const {
  const float height = (from - center_).dot(normal_);
  if (!(height > 0)) return std::nullopt;
  const SphericalRectangle seen = square(from);
  if (!(seen.solid_angle() > 0)) return std::nullopt;
  V3f to;
  const bool near = is_near(seen);
  if (near) {
    const V3d local = seen.sample(u.x, u.y);
    to = static_cast<float>(local.x) * x_ + static_cast<float>(local.y) * y_ - height * normal_;
    if (!((from + to - center_).length2() <= radius_ * radius_)) return std::nullopt;
  } else {
    const V2f place = radius_ * concentric_disk(u);
    to = center_ - from + place.x * x_ + place.y * y_;
  }
  const float distance = to.length();
  const float pdf = near ? static_cast<float>(seen.pdf(distance))
                         : distance * distance * distance / (height * kPi * radius_ * radius_);
  const float passed = grid_.factor(height / distance);
  if (!(passed > 0)) return std::nullopt;
  return LightSample{to / distance, distance, radiance_ * passed, pdf, normal_};
}

float DiskLight::pdf(const V3f& from, const V3f& direction) const {
  const std::optional<LightHit> hit = intersect(from, direction);
  if (!hit) return 0;
  const SphericalRectangle seen = square(from);
  if (is_near(seen)) return static_cast<float>(seen.pdf(hit->distance));
  const float distance = hit->distance, height = (from - center_).dot(normal_);
  return distance * distance * distance / (height * kPi * radius_ * radius_);
}

std::optional<LightHit> DiskLight::intersect(const V3f& from, const V3f& direction) const {
  const V3f from_center = from - center_;
  const float height = from_center.dot(normal_), descent = -direction.dot(normal_);
  if (!(height > 0) || !(descent > 0)) return std::nullopt;
  const float distance = height / descent;
  if (!((from_center + distance * direction).length2() <= radius_ * radius_)) return std::nullopt;
  const float passed = grid_.factor(descent);
  if (!(passed > 0)) return std::nullopt;
  return LightHit{distance, radiance_ * passed, normal_};
}

float DiskLight::importance(const V3f& from) const {
  if (!((from - center_).dot(normal_) > 0)) return 0;
  return luminance(radiance_) * static_cast<float>(square(from).solid_angle()) * (kPi / 4);
}

}  // namespace pelage
