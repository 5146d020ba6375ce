// SPDX-License-Identifier: Apache-2.0
#include "render/light/environment_light.h"

#include <cmath>

#include <fmt/format.h>

#include "base/memory_budget.h"
#include "render/sampling/warp.h"

namespace pelage {

namespace {
constexpr float kInfinity = std::numeric_limits<float>::infinity();
}

EnvironmentLight::EnvironmentLight(std::string name, const Rgb& radiance, bool visible)
    : Light(std::move(name), visible), radiance_(radiance), importance_(4.0f * kPi * luminance(radiance)) {}

EnvironmentLight::EnvironmentLight(std::string name, std::shared_ptr<const Texture> texture,
                                   const Rgb& factor, const M33f& to_world, bool visible,
                                   MemoryLedger& ledger, const std::function<void()>& check_stop)
    : Light(std::move(name), visible),
      radiance_(factor),
      to_world_(to_world),
      charge_(reserve(ledger, MemoryTag::kTextures,
                      static_cast<int64_t>(EnvironmentMap::bytes_for(texture->width(), texture->height())),
                      fmt::format("sampling light '{}' ({} x {} texels)", this->name(), texture->width(),
                                  texture->height()))),
      map_(std::make_unique<EnvironmentMap>(std::move(texture), factor, check_stop)),
      importance_(static_cast<float>(map_->power())) {}

std::optional<LightSample> EnvironmentLight::sample(const V3f&, const V2f& u) const {
  if (!(importance_ > 0.0f)) return std::nullopt;
  if (!map_) return LightSample{uniform_direction(u), kInfinity, radiance_, 1.0f / (4.0f * kPi)};
  const EnvironmentMap::Sample sample = map_->sample(u);
  const Rgb radiance = map_->radiance(sample.texel);
  return LightSample{sample.direction * to_world_, kInfinity, radiance, map_->pdf(radiance)};
}

float EnvironmentLight::pdf(const V3f&, const V3f& direction) const {
  if (!(importance_ > 0.0f)) return 0.0f;
  return map_ ? map_->pdf(map_->texel_of(to_map(direction))) : 1.0f / (4.0f * kPi);
}

float EnvironmentLight::pdf_of_hit(const V3f& from, const V3f& direction, const LightHit& hit) const {
  return map_ ? map_->pdf(hit.radiance) : pdf(from, direction);
}

std::optional<LightHit> EnvironmentLight::intersect(const V3f&, const V3f& direction) const {
  return LightHit{kInfinity, map_ ? map_->radiance(map_->texel_of(to_map(direction))) : radiance_};
}

std::optional<LightHit> EnvironmentLight::seen(const V3f&, const V3f& direction, float) const {
  return LightHit{kInfinity, map_ ? map_->interpolated(to_map(direction)) : radiance_};
}

float EnvironmentLight::importance(const V3f&) const { return importance_; }

V3f EnvironmentLight::to_map(const V3f& world) const {
  // The inverse of a rotation is its transpose.
  const M33f& m = to_world_;
  return {world.x * m[0][0] + world.y * m[0][1] + world.z * m[0][2],
          world.x * m[1][0] + world.y * m[1][1] + world.z * m[1][2],
          world.x * m[2][0] + world.y * m[2][1] + world.z * m[2][2]};
}

M33f rotation_xyz(const V3f& degrees) {
  const auto turn = [](float angle, int a, int b) {
    const double radians = angle * std::numbers::pi / 180;
    const float c = static_cast<float>(std::cos(radians)), s = static_cast<float>(std::sin(radians));
    M33f m;
    m[a][a] = c;
    m[a][b] = s;
    m[b][a] = -s;
    m[b][b] = c;
    return m;
  };
  return turn(degrees.x, 1, 2) * turn(degrees.y, 2, 0) * turn(degrees.z, 0, 1);
}

}  // namespace pelage
