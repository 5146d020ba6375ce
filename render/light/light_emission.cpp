// SPDX-License-Identifier: Apache-2.0
#include "render/light/light_emission.h"

#include <cmath>

#include "render/light/black_body.h"

namespace pelage {

Rgb LightEmission::color() const {
  return temperature ? radiance * black_body_color(*temperature) : radiance;
}

float LightEmission::strength(double frame) const {
  return intensity.at(frame) * std::exp2(exposure.at(frame));
}

}  // namespace pelage
