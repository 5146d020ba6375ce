// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>

#include "render/fibre/fibre_frame.h"
#include "render/fibre/fibre_value.h"
#include "render/surface/lambert.h"

namespace pelage {

/// An opaque diffuse cylinder, hit at h: rho = color / pi * max(0, n . wi), where n is the surface normal.
/// The average over h is the far field, rho = color cos(theta_i) ((pi - |phi|) cos phi + sin |phi|) / (4 pi).
class LambertCylinderBsdf {
 public:
  LambertCylinderBsdf(const Rgb& color, const FibreFrame& frame, float h)
      : surface_(color, frame.to_world({0, std::sqrt(std::max(0.0f, (1 - h) * (1 + h))), -h})) {}

  FibreValue eval(const V3f& wi) const { return as_fibre(surface_.eval(wi)); }
  std::optional<FibreSample> sample(const V3f& u) const {
    const std::optional<SurfaceSample> s = surface_.sample({u.x, u.y});
    if (!s) return std::nullopt;
    return FibreSample{s->wi, eval(s->wi)};
  }
  Rgb albedo() const { return surface_.albedo(); }

 private:
  static FibreValue as_fibre(const SurfaceValue& value) { return {{value.rho, Rgb(0), Rgb(0)}, value.pdf}; }
  LambertBsdf surface_;
};

}  // namespace pelage
