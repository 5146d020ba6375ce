// SPDX-License-Identifier: Apache-2.0
#include "render/fibre/attenuation.h"

#include <algorithm>
#include <cmath>

#include "render/fibre/dielectric.h"
#include "render/fibre/fibre_frame.h"

namespace pelage {

FibreCrossing::FibreCrossing(float eta, float layers, float sin_theta, float cos_theta, float h) {
  const float cos_gamma_o = std::sqrt(std::max(0.0f, (1 - h) * (1 + h)));
  // The angle to the normal is that in 3-D, so Fresnel's equations apply unchanged.
  const float cosine = cos_theta * cos_gamma_o;
  reflectance = layers > 0 ? cuticle_reflectance(cosine, eta, layers) : dielectric_reflectance(cosine, eta);
  const float eta_projected = std::sqrt(std::max(0.0f, eta * eta - sin_theta * sin_theta)) / cos_theta;
  sin_gamma_t = std::clamp(h / eta_projected, -1.0f, 1.0f);
  cos_gamma_t = std::sqrt((1 - sin_gamma_t) * (1 + sin_gamma_t));
  gamma_o = std::asin(h);
  gamma_t = std::asin(sin_gamma_t);
  const float sin_theta_t = sin_theta / eta;
  cos_theta_t = std::sqrt(std::max(1e-6f, (1 - sin_theta_t) * (1 + sin_theta_t)));
}

float FibreCrossing::exit_azimuth(int p) const {
  const auto legs = static_cast<float>(p);
  return wrapped_angle(legs * (2 * gamma_t + kPi) - 2 * gamma_o);
}

std::array<Rgb, kFibreLobes> attenuations(float reflectance, const Rgb& transmittance) {
  const float f = reflectance, passed = (1 - f) * (1 - f);
  std::array<Rgb, kFibreLobes> a;
  a[0] = Rgb(f);
  for (int c = 0; c < 3; ++c) {
    const float t = transmittance[c];
    a[1][c] = passed * t;
    a[2][c] = a[1][c] * f * t;
    // At grazing incidence, where f is 1, a[2] is already 0.
    a[3][c] = a[2][c] * f * t / std::max(1 - f * t, 1e-6f);
  }
  return a;
}

Rgb transmittance(const Rgb& sigma, float length) {
  return {std::exp(-sigma.x * length), std::exp(-sigma.y * length), std::exp(-sigma.z * length)};
}

}  // namespace pelage
