// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>

#include "base/vector.h"
#include "render/sampling/warp.h"

namespace pelage {

/// Number of lobes: R, TT and TRT, whose light paths have p = 0, 1 and 2 internal legs, and one lobe for all
/// longer paths.
inline constexpr int kFibreLobes = 4;

/// Geometry of light that hits a dielectric cylinder at h [Marschner03, section 4]; independent of colour.
/// Lengths in radii.
struct FibreCrossing {
  /// `layers`: of the cuticle, as in cuticle_reflectance(); 0 for one smooth interface.
  FibreCrossing(float eta, float layers, float sin_theta, float cos_theta, float h);

  float reflectance;
  float gamma_o, gamma_t;
  float sin_gamma_t, cos_gamma_t;
  float cos_theta_t;

  /// 3-D length of one leg from surface to surface.
  float leg() const { return 2 * cos_gamma_t / cos_theta_t; }
  /// Azimuth of light that leaves after p legs, Phi(p, h) = 2 p gamma_t - 2 gamma_o + p pi, in [-pi, pi].
  float exit_azimuth(int p) const;
};

/// Fraction of the light that leaves by each path when a leg transmits `transmittance` [Marschner03, equation
/// 6; the rest of the series as in Chiang16]. Sums to 1 without absorption.
std::array<Rgb, kFibreLobes> attenuations(float reflectance, const Rgb& transmittance);

/// exp(-sigma * length) by channel.
Rgb transmittance(const Rgb& sigma, float length);

}  // namespace pelage
