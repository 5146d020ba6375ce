// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <optional>

#include "render/fibre/attenuation.h"
#include "render/fibre/azimuthal.h"
#include "render/fibre/fibre_frame.h"
#include "render/fibre/fibre_value.h"
#include "render/fibre/half_angle_lobe.h"
#include "render/material/absorption.h"
#include "render/material/fibre_params.h"

namespace pelage {

class MarschnerBsdf;

/// Material constants of the far-field model of [Marschner03].
class MarschnerMaterial {
 public:
  explicit MarschnerMaterial(const MarschnerParams& params);
  /// `absorption` is used when the material does not define any.
  MarschnerBsdf at(const FibreFrame& frame, float h, const Rgb& absorption) const;

 private:
  friend class MarschnerBsdf;
  static constexpr int kLobes = 3, kAngles = 65;
  /// Factor of all lobes at theta_o: 1 as published, 1/2 for the halved variant.
  float scale(float theta_o) const;
  /// Mean over h of the light that a fibre without absorption scatters, as published.
  float white_albedo(float theta_o) const;

  float eta_;
  bool is_published_;
  std::optional<Rgb> absorption_;
  std::array<float, kLobes> alpha_, beta_;  // shift and width of each lobe in theta_h; radians
  WrappedGaussian azimuthal_;
  std::array<float, kAngles> scale_;  // at angles in equal steps from -pi/2 to pi/2
};

/// S = sum over p of M_p(theta_h) N_p(theta_d, phi) / cos^2(theta_d) [Marschner03, equation 9], at one h. M_p
/// is a Gaussian of unit area in theta_h. N_p is the attenuation at theta_d times a Gaussian about the exit
/// azimuth. Averaging N_p over h replaces the paper's root finding and caustics. The path length in the fibre
/// is 2 cos(gamma_t) / cos(theta_t); the formula printed in the paper is known to be wrong.
///
/// S reflects nearly twice the incoming energy, because unit area in theta_h is area 2 in theta_i. The
/// published variant uses S, the halved variant S / 2. The conserving variant, ours, divides S by the energy
/// that a fibre without absorption scatters at theta_o, averaged over h. So white fibres keep all light; like
/// [Chiang16] and [dEon11], this variant is not reciprocal. Keeps a reference to `material`.
class MarschnerBsdf {
 public:
  MarschnerBsdf(const MarschnerMaterial& material, const FibreFrame& frame, float h, const Rgb& sigma);

  FibreValue eval(const V3f& wi) const;
  /// Samples theta_h from the lobes, then the azimuth about the exit azimuth at the resulting theta_d.
  /// Attenuations, exit azimuths and the measure depend on theta_d. If lobes were evaluated at theta_o
  /// instead, sampling would miss the brightest light of slanted fibres.
  std::optional<FibreSample> sample(const V3f& u) const;
  /// Returns an approximate albedo: the sum of the attenuations at theta_o, times 2 for the published
  /// variant.
  Rgb albedo() const;

 private:
  static constexpr int kLobes = MarschnerMaterial::kLobes;
  /// Quantities that depend on theta_d alone.
  struct Crossing {
    FibreCrossing geometry;
    float cos_d;
  };
  Crossing crossing(float theta_d) const;
  /// Fraction of samples that are uniform over the sphere: 1 % normally, 1 when every lobe is black.
  float uniform_share() const;

  const MarschnerMaterial* material_;
  FibreFrame frame_;
  float h_;
  Rgb sigma_;
  float theta_o_, scale_;
  std::array<HalfAngleLobe, kLobes> lobes_;
  std::array<float, kLobes> choice_;
};

}  // namespace pelage
