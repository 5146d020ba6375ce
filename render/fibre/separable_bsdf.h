// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <optional>

#include "render/fibre/attenuation.h"
#include "render/fibre/fibre_frame.h"
#include "render/fibre/fibre_value.h"
#include "render/fibre/longitudinal.h"
#include "render/material/absorption.h"
#include "render/material/fibre_params.h"

namespace pelage {

/// Widths of the four lobes: R, TT, TRT, and a last lobe that represents all longer paths. Evaluation and
/// sampling share them, so that the two cannot disagree.
template <class Azimuth>
struct LobeWidths {
  std::array<LongitudinalLobe, kFibreLobes> longitudinal;
  std::array<Azimuth, kFibreLobes - 1> azimuthal;  ///< the last lobe is uniform
  /// Sines and cosines of the tilts of R, TT and TRT. A lobe adds its tilt to theta_o before it mirrors the
  /// direction.
  std::array<float, kFibreLobes - 1> sin_tilt{0, 0, 0}, cos_tilt{1, 1, 1};

  void set_tilt(int p, float radians) {
    sin_tilt[p] = std::sin(radians);
    cos_tilt[p] = std::cos(radians);
  }
};

/// A sum of lobes for light that hits a fibre at one h: sum over p of A_p M_p(theta_i) N_p(phi), with
/// longitudinal densities M and azimuthal densities N [Marschner03, equation 5]. Keeps a reference to
/// `widths`.
///
/// Every lobe is sampled exactly, so sample weights vary only because the lobes differ in colour. The energy
/// is the sum of the A_p.
template <class Azimuth>
class SeparableBsdf {
 public:
  SeparableBsdf(const LobeWidths<Azimuth>& widths, const FibreFrame& frame,
                const std::array<float, kFibreLobes - 1>& exit_azimuths,
                const std::array<Rgb, kFibreLobes>& amplitudes)
      : widths_(&widths), frame_(frame), azimuth_(exit_azimuths), amplitude_(amplitudes) {
    for (int p = 0; p < kFibreLobes; ++p) {
      const float sin_tilt = p < 3 ? widths.sin_tilt[p] : 0, cos_tilt = p < 3 ? widths.cos_tilt[p] : 1;
      sin_o_[p] = frame.sin_theta_o() * cos_tilt + frame.cos_theta_o() * sin_tilt;
      // If the tilt moves theta_o beyond 90 degrees, its cosine is negative. The absolute value keeps M
      // normalised.
      cos_o_[p] = std::abs(frame.cos_theta_o() * cos_tilt - frame.sin_theta_o() * sin_tilt);
      choice_[p] = (amplitude_[p].x + amplitude_[p].y + amplitude_[p].z) / 3;
    }
    const float total = choice_[0] + choice_[1] + choice_[2] + choice_[3];
    for (float& c : choice_) c = total > 0 ? c / total : 0;
  }

  const FibreFrame& frame() const { return frame_; }

  /// Returns the density of each lobe at a direction, per solid angle.
  std::array<float, kFibreLobes> densities(const FibreAngles& wi) const {
    std::array<float, kFibreLobes> d;
    for (int p = 0; p < kFibreLobes; ++p) {
      const float m = widths_->longitudinal[p].density(wi.sin_theta, wi.cos_theta, sin_o_[p], cos_o_[p]);
      const float n = p < 3 ? widths_->azimuthal[p].density(wrapped_angle(wi.phi - azimuth_[p])) : 0.5f / kPi;
      d[p] = m * n;
    }
    return d;
  }

  FibreValue eval(const V3f& wi) const { return eval(frame_.angles(wi)); }
  FibreValue eval(const FibreAngles& wi) const {
    const std::array<float, kFibreLobes> d = densities(wi);
    FibreValue value;
    value[LobeGroup::kPrimary] = amplitude_[0] * d[0];
    value[LobeGroup::kDiffuse] = amplitude_[1] * d[1] + amplitude_[3] * d[3];
    value[LobeGroup::kSecondary] = amplitude_[2] * d[2];
    value.pdf = choice_[0] * d[0] + choice_[1] * d[1] + choice_[2] * d[2] + choice_[3] * d[3];
    return value;
  }

  /// Samples a direction without evaluating it. u.x selects the azimuth. u.y selects the distance from the
  /// peak. u.z selects the lobe; rescaled to [0, 1) within its lobe, it also selects the angle about the
  /// peak.
  V3f sample_direction(const V3f& u) const {
    int p = 0;
    float rest = u.z;
    while (p < kFibreLobes - 1 && rest >= choice_[p]) rest -= choice_[p++];
    const float stretched = choice_[p] > 0 ? std::min(rest / choice_[p], kBelowOne) : 0.5f;
    const float z = widths_->longitudinal[p].sample({u.y, stretched}, sin_o_[p], cos_o_[p]);
    const float phi = p < 3 ? azimuth_[p] + widths_->azimuthal[p].sample(u.x) : kPi * (2 * u.x - 1);
    return frame_.direction(z, std::sqrt((1 - z) * (1 + z)), phi);
  }
  std::optional<FibreSample> sample(const V3f& u) const {
    FibreSample s;
    s.wi = sample_direction(u);
    s.value = eval(s.wi);
    if (!(s.value.pdf > 0)) return std::nullopt;
    return s;
  }

  Rgb albedo() const { return amplitude_[0] + amplitude_[1] + amplitude_[2] + amplitude_[3]; }

 private:
  const LobeWidths<Azimuth>* widths_;
  FibreFrame frame_;
  std::array<float, kFibreLobes - 1> azimuth_;
  std::array<Rgb, kFibreLobes> amplitude_;
  std::array<float, kFibreLobes> sin_o_, cos_o_, choice_;
};

/// Constants of a material whose lobes are a SeparableBsdf. Models derive from this class and set the widths.
template <class Azimuth>
class SeparableMaterial {
 public:
  /// Returns the scattering of a fibre hit at `h`. The result refers to the material.
  SeparableBsdf<Azimuth> at(const FibreFrame& frame, float h, const Rgb& color) const {
    const FibreCrossing crossing(eta_, 0, frame.sin_theta_o(), frame.cos_theta_o(), h);
    const Rgb sigma = fibre_absorption(absorption_, by_color_, color);
    return {widths_,
            frame,
            {crossing.exit_azimuth(0), crossing.exit_azimuth(1), crossing.exit_azimuth(2)},
            attenuations(crossing.reflectance, transmittance(sigma, crossing.leg()))};
  }

 protected:
  /// `color_roughness`: azimuthal roughness for the fit that converts colour to absorption.
  SeparableMaterial(float eta, const AbsorptionParams& absorption, float color_roughness)
      : eta_(eta), absorption_(absorption), by_color_(color_roughness) {}

  LobeWidths<Azimuth> widths_;

 private:
  float eta_;
  AbsorptionParams absorption_;
  ColorToAbsorption by_color_;
};

}  // namespace pelage
