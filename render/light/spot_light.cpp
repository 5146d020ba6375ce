// SPDX-License-Identifier: Apache-2.0
#include "render/light/spot_light.h"

#include <algorithm>
#include <cmath>
#include <numbers>

namespace pelage {
namespace {

/// The factor of a cone by the angle to its axis: a cubic step between the cosines of its borders.
float faded(const SpotCone& cone, float cosine) {
  if (cone.half_angle >= std::numbers::pi_v<float>) return 1;
  const float outer = std::cos(cone.half_angle), inner = std::cos(cone.half_angle * (1 - cone.softness));
  if (!(inner > outer)) return cosine >= outer ? 1.0f : 0.0f;
  const float t = std::clamp((cosine - outer) / (inner - outer), 0.0f, 1.0f);
  return t * t * (3 - 2 * t);
}

}  // namespace

Rgb SpotCone::factor(const V3f& direction) const {
  const float cosine = direction.dot(axis);
  float fade = faded(*this, cosine);
  if (fade > 0 && profile) fade *= profile->factor({direction.dot(x), direction.dot(y), cosine});
  if (!(fade > 0) || !gobo) return Rgb(fade);
  const float unit = 0.5f / (cosine * std::tan(half_angle));
  return fade * gobo->color(0.5f + unit * direction.dot(x), 0.5f + unit * direction.dot(y));
}

SpotLight::SpotLight(std::string name, const V3f& center, float radius, SpotCone cone, const Rgb& radiance,
                     bool visible)
    : Light(name, visible),
      sphere_(std::move(name), center, radius, radiance, visible),
      cone_(std::move(cone)) {}

bool SpotLight::is_dark() const {
  return cone_.profile && cone_.profile->is_dark_within(cone_.half_angle * 180 / std::numbers::pi_v<float>);
}

std::optional<LightSample> SpotLight::sample(const V3f& from, const V2f& u) const {
  std::optional<LightSample> sample = sphere_.sample(from, u);
  if (!sample) return std::nullopt;
  sample->radiance *= cone_.factor(-sample->direction);
  return max_component(sample->radiance) > 0 ? sample : std::nullopt;
}

float SpotLight::pdf(const V3f& from, const V3f& direction) const {
  return intersect(from, direction) ? 1 / sphere_.solid_angle(from) : 0.0f;
}

std::optional<LightHit> SpotLight::intersect(const V3f& from, const V3f& direction) const {
  std::optional<LightHit> hit = sphere_.intersect(from, direction);
  if (!hit) return std::nullopt;
  hit->radiance *= cone_.factor(-direction);
  return max_component(hit->radiance) > 0 ? hit : std::nullopt;
}

float SpotLight::importance(const V3f& from) const {
  const LightBall ball = *sphere_.ball();
  const V3f away = from - ball.center;
  const float distance = away.length();
  if (!(distance > ball.radius)) return sphere_.importance(from);
  float brightness = 1;
  if (cone_.profile) {
    const V3f direction = away / distance;
    brightness = std::max(0.1f, cone_.profile->factor({direction.dot(cone_.x), direction.dot(cone_.y),
                                                       direction.dot(cone_.axis)}));
  }
  // The direction of the sphere's light at `from` that is nearest to the axis.
  const float to_center = std::acos(std::clamp(away.dot(cone_.axis) / distance, -1.0f, 1.0f));
  const float nearest = std::max(0.0f, to_center - std::asin(ball.radius / distance));
  return sphere_.importance(from) * brightness * faded(cone_, std::cos(nearest));
}

}  // namespace pelage
