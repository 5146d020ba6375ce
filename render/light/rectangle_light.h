// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <memory>

#include "image/texture.h"
#include "render/light/barn_doors.h"
#include "render/light/light.h"
#include "render/light/spread_grid.h"

namespace pelage {

/// A rectangle in space. `x` and `y` are perpendicular unit vectors. The emitting side faces x cross y.
struct Rectangle {
  V3f center{0};
  V3f x{1, 0, 0};
  V3f y{0, 1, 0};
  V2f half_size{0.5f};
};

/// How the radiance of a rectangle depends on place and direction.
struct RectangleShaping {
  std::shared_ptr<const Texture> image =
      {};  ///< factor, upright and not mirrored from the emitting side; null: 1
  SpreadGrid grid = {};
  BarnDoors doors = {};  ///< on both sides if both emit
};

/// A rectangle of constant radiance, or with an image, a grid or barn doors, sampled uniformly in solid angle
/// [Urena13]. Where its solid angle is too small to be computed accurately, the rectangle is sampled
/// uniformly in area instead.
class RectangleLight final : public Light {
 public:
  /// `radiance`: along the normal, without the image.
  RectangleLight(std::string name, const Rectangle& shape, const Rgb& radiance, bool two_sided, bool visible,
                 RectangleShaping shaping = {});

  std::optional<LightSample> sample(const V3f& from, const V2f& u) const override;
  float pdf(const V3f& from, const V3f& direction) const override;
  std::optional<LightHit> intersect(const V3f& from, const V3f& direction) const override;
  /// As Light::importance(), without the grid and the doors.
  float importance(const V3f& from) const override;
  std::optional<LightBall> ball() const override {
    return LightBall{shape_.center, shape_.half_size.length()};
  }

  /// Returns the solid angle of the rectangle seen from `from`, in steradians, for either side.
  double solid_angle(const V3f& from) const;

 private:
  /// Returns the radiance of the point `place`, relative to the centre, against `direction`, which points to
  /// the light. Empty if the grid or the doors block it.
  std::optional<Rgb> radiance_at(const V2f& place, const V3f& direction) const;
  bool emits_toward(float height) const { return two_sided_ ? height != 0.0f : height > 0.0f; }

  Rectangle shape_;
  V3f normal_;
  Rgb radiance_;
  float luminance_;  // mean
  bool two_sided_;
  RectangleShaping shaping_;
};

}  // namespace pelage
