// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <memory>

#include "image/texture.h"
#include "render/light/light_profile.h"
#include "render/light/sphere_light.h"

namespace pelage {

/// The directions in which a spot shines, and how brightly.
struct SpotCone {
  V3f x{1, 0, 0}, y{0, 1, 0}, axis{0, 0, 1};  ///< unit, perpendicular; the spot shines along `axis`
  float half_angle = 0.35f;                   ///< radians, less than pi / 2, or pi: all directions
  float softness = 0;  ///< the spot fades over this fraction of the half angle, from 0 to 1
  std::shared_ptr<const Texture> gobo = {};          ///< pattern in the square around the cone; null: none
  std::shared_ptr<const LightProfile> profile = {};  ///< null: equally bright in all directions of the cone

  /// Returns the factor of the radiance in a direction (unit) from the spot.
  Rgb factor(const V3f& direction) const;
};

/// A sphere whose radiance depends on the direction: a spotlight, or a lamp with a profile. Sampled as
/// SphereLight; directions without light are no samples.
class SpotLight final : public Light {
 public:
  /// `radiance`: where the factor of the cone is 1.
  SpotLight(std::string name, const V3f& center, float radius, SpotCone cone, const Rgb& radiance,
            bool visible);

  /// Returns whether the profile has no light within the cone.
  bool is_dark() const;
  std::optional<LightSample> sample(const V3f& from, const V2f& u) const override;
  float pdf(const V3f& from, const V3f& direction) const override;
  std::optional<LightHit> intersect(const V3f& from, const V3f& direction) const override;
  /// As Light::importance(), with an upper bound of the cone's factor, the profile's factor in the direction
  /// of `from`, but at least a tenth of its mean, and without the gobo.
  float importance(const V3f& from) const override;
  std::optional<LightBall> ball() const override { return sphere_.ball(); }

 private:
  SphereLight sphere_;
  SpotCone cone_;
};

}  // namespace pelage
