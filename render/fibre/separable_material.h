// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "render/fibre/separable_bsdf.h"
#include "render/material/absorption.h"
#include "render/material/fibre_params.h"

namespace pelage {

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
