// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "render/light/light.h"

namespace pelage {

/// A sphere of constant radiance, sampled uniformly in solid angle. At a point inside the sphere, its light
/// arrives from every direction.
class SphereLight final : public Light {
 public:
  SphereLight(std::string name, const V3f& center, float radius, const Rgb& radiance, bool visible);

  std::optional<LightSample> sample(const V3f& from, const V2f& u) const override;
  float pdf(const V3f& from, const V3f& direction) const override;
  std::optional<LightHit> intersect(const V3f& from, const V3f& direction) const override;
  float importance(const V3f& from) const override;
  std::optional<LightBall> ball() const override { return LightBall{center_, radius_}; }

  /// Returns the solid angle of the sphere seen from `from`, in steradians; 4 pi if `from` is inside.
  float solid_angle(const V3f& from) const;

 private:
  V3f center_;
  float radius_;
  Rgb radiance_;
  float luminance_;
};

}  // namespace pelage
