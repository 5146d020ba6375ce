// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "render/fibre/fibre_material.h"
#include "tests/render/random.h"
#include "tests/render/sphere_statistics.h"

namespace pelage {

/// A fibre along an oblique axis, seen at theta_o, met at h.
inline FibrePoint fibre_point_at(float theta_o, float h, const Rgb& color = Rgb(0.5f, 0.3f, 0.15f)) {
  FibrePoint point;
  const SphereGrid axis(V3f(0.36f, 0.48f, 0.8f));
  point.tangents.fill(axis.axis);
  point.wo = axis.direction(std::sin(theta_o), 0.137);
  point.h = h;
  point.color = color;
  return point;
}
/// Coordinates about that fibre.
inline SphereGrid fibre_grid(const FibrePoint& point) { return SphereGrid(point.tangents[0]); }

/// The direction at an inclination and azimuth in the frame of the models.
inline V3f fibre_direction(const FibrePoint& point, float theta, float phi) {
  return FibreFrame(point.tangents[0], point.wo).direction(std::sin(theta), std::cos(theta), phi);
}

}  // namespace pelage
