// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <algorithm>
#include <cmath>

namespace pelage {

/// Reflectances of a smooth dielectric for light polarised perpendicular and parallel to the plane of
/// incidence.
struct Reflectances {
  float perpendicular = 1, parallel = 1;
};

/// Returns the reflectances by Fresnel's equations for light from outside. `cosine`: of the angle of
/// incidence, in [0, 1]. `eta`: index of refraction inside / outside, at least 1.
inline Reflectances fresnel(float cosine, float eta) {
  const float c = std::clamp(cosine, 0.0f, 1.0f);
  const float inside = std::sqrt(std::max(0.0f, 1 - (1 - c * c) / (eta * eta)));
  const float s = (c - eta * inside) / (c + eta * inside);
  const float p = (eta * c - inside) / (eta * c + inside);
  return {s * s, p * p};
}

/// Returns the reflectance for unpolarised light; arguments as for fresnel().
inline float dielectric_reflectance(float cosine, float eta) {
  const Reflectances r = fresnel(cosine, eta);
  return 0.5f * (r.perpendicular + r.parallel);
}

/// Returns the reflectance of a stack of cuticle scales instead of one interface [Yan15, equation 7]. One
/// layer has two interfaces. Including all reflections between them, a layer reflects the fraction p = 2 r /
/// (1 + r) of each polarisation, where r is the reflectance of one interface. A stack of n layers reflects
/// the fraction n p / (1 + (n - 1) p). Half a layer reflects as much as one interface: exactly at normal
/// incidence, approximately at other angles.
inline float cuticle_reflectance(float cosine, float eta, float layers) {
  const Reflectances r = fresnel(cosine, eta);
  const float layer = r.perpendicular / (1 + r.perpendicular) + r.parallel / (1 + r.parallel);
  return std::min(1.0f, layers * layer / (1 + (layers - 1) * layer));
}

}  // namespace pelage
