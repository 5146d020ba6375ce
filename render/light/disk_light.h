// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "render/light/light.h"
#include "render/light/spherical_rectangle.h"
#include "render/light/spread_grid.h"

namespace pelage {

/// A disk of constant radiance, or with a grid, that emits to one side. Near the disk, directions are sampled
/// uniformly in the solid angle of the square around the disk [Urena13]; those that miss the disk are no
/// samples. Far from the disk, where the angle and the distance to all its points are similar, its area is
/// sampled uniformly.
class DiskLight final : public Light {
 public:
  /// `normal`: unit, on the emitting side. `radiance`: along the normal.
  DiskLight(std::string name, const V3f& center, const V3f& normal, float radius, const Rgb& radiance,
            bool visible, const SpreadGrid& grid = {});

  std::optional<LightSample> sample(const V3f& from, const V2f& u) const override;
  float pdf(const V3f& from, const V3f& direction) const override;
  std::optional<LightHit> intersect(const V3f& from, const V3f& direction) const override;
  /// As Light::importance(), with the solid angle of the square around the disk * pi / 4, without the
  /// grid.
  float importance(const V3f& from) const override;
  std::optional<LightBall> ball() const override { return LightBall{center_, radius_}; }

 private:
  SphericalRectangle square(const V3f& from) const;
  static bool is_near(const SphericalRectangle& square);

  V3f center_, normal_, x_, y_;
  float radius_;
  Rgb radiance_;
  SpreadGrid grid_;
};

}  // namespace pelage
