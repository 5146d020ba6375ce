// SPDX-License-Identifier: Apache-2.0
#include "render/light/rectangle_light.h"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "render/light/spherical_rectangle.h"

namespace pelage {

namespace {

SphericalRectangle seen_from(const Rectangle& shape, const V3f& normal, const V3f& from) {
  const V3f to_center = shape.center - from;
  return {to_center.dot(shape.x), to_center.dot(shape.y), to_center.dot(normal), shape.half_size.x,
          shape.half_size.y};
}

/// Mean of an image, from at most 256 x 256 lookups.
Rgb mean_color(const Texture& image) {
  const int width = std::min(image.width(), 256), height = std::min(image.height(), 256);
  V3d sum(0);
  for (int y = 0; y < height; ++y) {
    for (int x = 0; x < width; ++x) {
      sum += V3d(image.color((static_cast<float>(x) + 0.5f) / static_cast<float>(width),
                             (static_cast<float>(y) + 0.5f) / static_cast<float>(height)));
    }
  }
  return Rgb(sum / (double{1} * width * height));
}

}  // namespace

RectangleLight::RectangleLight(std::string name, const Rectangle& shape, const Rgb& radiance, bool two_sided,
                               bool visible, RectangleShaping shaping)
    : Light(std::move(name), visible),
      shape_(shape),
      normal_(shape.x.cross(shape.y)),
      radiance_(radiance),
      luminance_(luminance(radiance)),
      two_sided_(two_sided),
      shaping_(std::move(shaping)) {
  if (shaping_.image) luminance_ = luminance(radiance * mean_color(*shaping_.image));
}

std::optional<Rgb> RectangleLight::radiance_at(const V2f& place, const V3f& direction) const {
  const V3f out(-direction.dot(shape_.x), -direction.dot(shape_.y), std::abs(direction.dot(normal_)));
  const float passed = shaping_.grid.factor(out.z);
  if (!(passed > 0) || !shaping_.doors.pass(place, shape_.half_size, out)) return std::nullopt;
  if (!shaping_.image) return radiance_ * passed;
  return radiance_ * passed *
         shaping_.image->color(0.5f + 0.5f * place.x / shape_.half_size.x,
                               0.5f + 0.5f * place.y / shape_.half_size.y);
}

double RectangleLight::solid_angle(const V3f& from) const {
  return seen_from(shape_, normal_, from).solid_angle();
}

std::optional<LightSample> RectangleLight::sample(const V3f& from, const V2f& u) const {
  if (!emits_toward((from - shape_.center).dot(normal_))) return std::nullopt;
  const SphericalRectangle seen = seen_from(shape_, normal_, from);
  if (!(seen.solid_angle() > 0)) return std::nullopt;
  const V3d local = seen.sample(u.x, u.y);
  const double distance = std::sqrt(local.dot(local));
  const V3f x = static_cast<float>(local.x / distance) * shape_.x;
  const V3f y = static_cast<float>(local.y / distance) * shape_.y;
  const V3f z = static_cast<float>(local.z / distance) * normal_;
  const V3f on_plane = from - shape_.center + static_cast<float>(distance) * (x + y + z);
  const std::optional<Rgb> radiance =
      radiance_at({on_plane.dot(shape_.x), on_plane.dot(shape_.y)}, x + y + z);
  if (!radiance) return std::nullopt;
  return LightSample{x + y + z, static_cast<float>(distance), *radiance,
                     static_cast<float>(seen.pdf(distance)), normal_};
}

float RectangleLight::pdf(const V3f& from, const V3f& direction) const {
  const std::optional<LightHit> hit = intersect(from, direction);
  return hit ? static_cast<float>(seen_from(shape_, normal_, from).pdf(hit->distance)) : 0.0f;
}

std::optional<LightHit> RectangleLight::intersect(const V3f& from, const V3f& direction) const {
  const V3f from_center = from - shape_.center;
  const float height = from_center.dot(normal_);
  const float descent = -direction.dot(normal_);
  if (!emits_toward(height) || !(height * descent > 0.0f)) return std::nullopt;
  const float distance = height / descent;
  const V3f on_plane = from_center + distance * direction;
  const float x = on_plane.dot(shape_.x), y = on_plane.dot(shape_.y);
  if (!(std::abs(x) <= shape_.half_size.x) || !(std::abs(y) <= shape_.half_size.y)) return std::nullopt;
  const std::optional<Rgb> radiance = radiance_at({x, y}, direction);
  if (!radiance) return std::nullopt;
  return LightHit{distance, *radiance, normal_};
}

float RectangleLight::importance(const V3f& from) const {
  if (!emits_toward((from - shape_.center).dot(normal_))) return 0.0f;
  return luminance_ * static_cast<float>(solid_angle(from));
}

}  // namespace pelage
