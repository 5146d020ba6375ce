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

/// Fresnel's equations at an incident cosine in [0, 1], from the outside; `eta` = inside / outside >= 1.
inline Reflectances fresnel(float cosine, float eta) {
  const float c = std::clamp(cosine, 0.0f, 1.0f);
  const float inside = std::sqrt(std::max(0.0f, 1 - (1 - c * c) / (eta * eta)));
  const float s = (c - eta * inside) / (c + eta * inside);
  const float p = (eta * c - inside) / (eta * c + inside);
  return {s * s, p * p};
}

/// For unpolarised light.
inline float dielectric_reflectance(float cosine, float eta) {
  const Reflectances r = fresnel(cosine, eta);
  return 0.5f * (r.perpendicular + r.parallel);
}

/// Reflectance of a stack of cuticle scales instead of one interface [Yan15, equation 7]. One layer has two
/// interfaces. With all reflections between them it reflects p = 2 r / (1 + r) per polarisation, where r is
/// the reflectance of one interface. A number l of layers reflects l p / (1 + (l - 1) p). Half a layer equals
/// one interface: exactly at normal incidence, approximately elsewhere.
inline float cuticle_reflectance(float cosine, float eta, float layers) {
  const Reflectances r = fresnel(cosine, eta);
  const float layer = r.perpendicular / (1 + r.perpendicular) + r.parallel / (1 + r.parallel);
  return std::min(1.0f, layers * layer / (1 + (layers - 1) * layer));
}

}  // namespace pelage
