// SPDX-License-Identifier: Apache-2.0
#include "render/light/sun_light.h"

#include <cmath>

#include "render/sampling/warp.h"

namespace pelage {

SunLight::SunLight(std::string name, const V3f& toward, float half_angle, const Rgb& radiance, bool visible)
    : Light(std::move(name), visible), toward_(toward), radiance_(radiance) {
  complete_frame(toward_, x_, y_);
  const double sine = std::sin(double{half_angle}), half_sine = std::sin(0.5 * double{half_angle});
  sin2_ = static_cast<float>(sine * sine);
  height_ = static_cast<float>(2 * half_sine * half_sine);
  solid_angle_ = 2 * kPi * height_;
}

std::optional<LightSample> SunLight::sample(const V3f&, const V2f& u) const {
  const float drop = u.x * height_;  // 1 - cos of the angle to the centre
  const float sine = std::sqrt(drop * (2 - drop)), phi = 2 * kPi * u.y;
  const V3f direction = (1 - drop) * toward_ + (sine * std::cos(phi)) * x_ + (sine * std::sin(phi)) * y_;
  return LightSample{direction, std::numeric_limits<float>::infinity(), radiance_, 1 / solid_angle_};
}

float SunLight::pdf(const V3f& from, const V3f& direction) const {
  return intersect(from, direction) ? 1 / solid_angle_ : 0.0f;
}

std::optional<LightHit> SunLight::intersect(const V3f&, const V3f& direction) const {
  // The sine, because the cosine does not resolve small angles.
  if (!(direction.dot(toward_) > 0) || !(direction.cross(toward_).length2() <= sin2_)) return std::nullopt;
  return LightHit{std::numeric_limits<float>::infinity(), radiance_};
}

float SunLight::importance(const V3f&) const { return luminance(radiance_) * solid_angle_; }

}  // namespace pelage
