// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>

#include "base/vector.h"
#include "render/sampling/warp.h"

namespace pelage {

/// Scattering of a surface for one direction: rho = f cos(theta_i) per solid angle, where theta_i is the
/// angle to the normal.
struct SurfaceValue {
  Rgb rho{0};
  float pdf = 0;  ///< density of sample(), per solid angle
};

struct SurfaceSample {
  V3f wi{0};
  SurfaceValue value;
};

/// Ideal diffuse reflection on one side of a surface. `normal`: unit, on the side of the viewer. Directions
/// are in world space and point away from the surface.
class LambertBsdf {
 public:
  LambertBsdf(const Rgb& albedo, const V3f& normal) : albedo_(albedo), normal_(normal) {}

  SurfaceValue eval(const V3f& wi) const {
    const float pdf = std::max(0.0f, wi.dot(normal_)) / kPi;
    return {albedo_ * pdf, pdf};
  }
  /// Samples a direction in proportion to its cosine. For every sample, rho / pdf is the albedo.
  std::optional<SurfaceSample> sample(const V2f& u) const {
    const V2f disk = concentric_disk(u);
    const float cosine = std::sqrt(std::max(0.0f, 1.0f - disk.length2()));
    if (!(cosine > 0)) return std::nullopt;
    V3f x, y;
    complete_frame(normal_, x, y);
    const float pdf = cosine / kPi;
    return SurfaceSample{disk.x * x + disk.y * y + cosine * normal_, {albedo_ * pdf, pdf}};
  }
  const Rgb& albedo() const { return albedo_; }

 private:
  Rgb albedo_;
  V3f normal_;
};

}  // namespace pelage
