// SPDX-License-Identifier: Apache-2.0
#include "render/material/absorption.h"

#include <algorithm>
#include <cmath>

namespace pelage {

ColorToAbsorption::ColorToAbsorption(float azimuthal_roughness) {
  const float b = azimuthal_roughness;
  inverse_slope_ = 1 / (5.969f + b * (-0.215f + b * (2.532f + b * (-10.73f + b * (5.574f + b * 0.245f)))));
}

Rgb ColorToAbsorption::operator()(const Rgb& color) const {
  Rgb sigma;
  for (int c = 0; c < 3; ++c) {
    const float root = std::log(std::clamp(color[c], 1e-3f, 1.0f)) * inverse_slope_;
    sigma[c] = root * root;
  }
  return sigma;
}

}  // namespace pelage
