// SPDX-License-Identifier: Apache-2.0
#include "render/fibre/chiang.h"

#include <cmath>

namespace pelage {

float chiang_variance(float beta_m) {
  const float root = 0.726f * beta_m + 0.812f * beta_m * beta_m + 3.7f * std::pow(beta_m, 20.0f);
  return root * root;
}

float chiang_scale(float beta_n) {
  return std::sqrt(kPi / 8) * (0.265f * beta_n + 1.194f * beta_n * beta_n + 5.372f * std::pow(beta_n, 22.0f));
}

ChiangMaterial::ChiangMaterial(const ChiangParams& params)
    : SeparableMaterial(params.eta, params, params.beta_n) {
  const float v = chiang_variance(params.beta_m);
  widths_.longitudinal = {LongitudinalLobe(v), LongitudinalLobe(v / 4), LongitudinalLobe(4 * v),
                          LongitudinalLobe(4 * v)};
  widths_.azimuthal.fill(TrimmedLogistic(chiang_scale(params.beta_n)));
  const float alpha = params.alpha * (kPi / 180);
  widths_.set_tilt(0, 2 * alpha);
  widths_.set_tilt(1, -alpha);
  widths_.set_tilt(2, -4 * alpha);
}

}  // namespace pelage
