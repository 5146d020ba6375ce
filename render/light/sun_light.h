// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "render/light/light.h"

namespace pelage {

/// A disc of constant radiance at infinity, such as the sun: light from a cone of directions, sampled
/// uniformly in solid angle.
class SunLight final : public Light {
 public:
  /// `toward`: unit, to the centre of the disc. `half_angle`: of the cone, in radians, in (0, pi / 2].
  SunLight(std::string name, const V3f& toward, float half_angle, const Rgb& radiance, bool visible);

  bool is_infinitely_far() const override { return true; }
  std::optional<LightSample> sample(const V3f& from, const V2f& u) const override;
  float pdf(const V3f& from, const V3f& direction) const override;
  std::optional<LightHit> intersect(const V3f& from, const V3f& direction) const override;
  float importance(const V3f& from) const override;
  std::optional<LightBall> ball() const override { return std::nullopt; }

 private:
  V3f toward_, x_, y_;
  float sin2_;         // of the half angle
  float height_;       // 1 - cos of the half angle
  float solid_angle_;  // steradians
  Rgb radiance_;
};

}  // namespace pelage
