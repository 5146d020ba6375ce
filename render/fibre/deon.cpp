// SPDX-License-Identifier: Apache-2.0
#include "render/fibre/deon.h"

namespace pelage {

DeonMaterial::DeonMaterial(const DeonParams& params)
    : SeparableMaterial(params.eta, params, kColorRoughness) {
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

}  // namespace pelage
