// SPDX-License-Identifier: Apache-2.0
#include "render/fibre/deon.h"

namespace pelage {

DeonMaterial::DeonMaterial(const DeonParams& params)
    : eta_(params.eta), absorption_(params), by_color_(kColorRoughness) {
  const float beta = params.beta * (kPi / 180), v = beta * beta;
  widths_.longitudinal = {LongitudinalLobe(v), LongitudinalLobe(v / 4), LongitudinalLobe(4 * v),
                          LongitudinalLobe(4 * v)};
  widths_.azimuthal.fill(WrappedGaussian(params.azimuthal_width * (kPi / 180)));
  // alpha of R; TT has -1/2 and TRT -3/2 of it [Marschner03, table 1].
  const float alpha = params.alpha * (kPi / 180);
  widths_.set_tilt(0, -2 * alpha);
  widths_.set_tilt(1, alpha);
  widths_.set_tilt(2, 3 * alpha);
}

DeonBsdf DeonMaterial::at(const FibreFrame& frame, float h, const Rgb& color) const {
  const FibreCrossing crossing(eta_, 0, frame.sin_theta_o(), frame.cos_theta_o(), h);
  const Rgb sigma = fibre_absorption(absorption_, by_color_, color);
  return {widths_,
          frame,
          {crossing.exit_azimuth(0), crossing.exit_azimuth(1), crossing.exit_azimuth(2)},
          attenuations(crossing.reflectance, transmittance(sigma, crossing.leg()))};
}

}  // namespace pelage
