// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>

#include "base/vector.h"
#include "render/sampling/warp.h"

namespace pelage {

/// Number of lobes: R, TT and TRT, whose light paths have p = 0, 1 and 2 internal legs (straight lines from
/// surface to surface), and one lobe for all longer paths.
inline constexpr int kFibreLobes = 4;

/// Geometry of light that hits a dielectric cylinder at h [Marschner03, section 4]; independent of colour.
/// Lengths in radii.
struct FibreCrossing {
  /// `layers`: number of layers of the cuticle, as in cuticle_reflectance(); 0 for one smooth interface.
  FibreCrossing(float eta, float layers, float sin_theta, float cos_theta, float h);

  float reflectance;
  float gamma_o, gamma_t;  ///< angles to the normal in the cross-section, outside and inside; radians
  float sin_gamma_t, cos_gamma_t;
  float cos_theta_t;

  /// 3-D length of one leg from surface to surface, in radii.
  float leg() const { return 2 * cos_gamma_t / cos_theta_t; }
  /// Returns the azimuth of light that leaves after p legs: Phi(p, h) = 2 p gamma_t - 2 gamma_o + p pi,
  /// wrapped to [-pi, pi].
  float exit_azimuth(int p) const;
};

/// Returns the fraction of the light that leaves in each lobe, if each leg transmits the fraction
/// `transmittance` [Marschner03, equation 6]. The last lobe is the rest of the series, as in [Chiang16].
/// Without absorption, the fractions add up to 1.
std::array<Rgb, kFibreLobes> attenuations(float reflectance, const Rgb& transmittance);

/// Returns exp(-sigma * length) for each channel.
Rgb transmittance(const Rgb& sigma, float length);

}  // namespace pelage
