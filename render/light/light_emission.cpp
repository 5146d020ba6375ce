// SPDX-License-Identifier: Apache-2.0
#include "render/light/light_emission.h"

#include <algorithm>
#include <cmath>

namespace pelage {
namespace {

double cubic(double t, double a, double b, double c, double d) { return ((a * t + b) * t + c) * t + d; }

}  // namespace

Rgb black_body_color(float kelvin) {
  const double t = std::clamp(double{kelvin}, kCoolestBlackBody, kHottestBlackBody);
  const double x = t < 4000 ? cubic(1 / t, -0.2661239e9, -0.2343589e6, 0.8776956e3, 0.179910)
                            : cubic(1 / t, -3.0258469e9, 2.1070379e6, 0.2226347e3, 0.240390);
  const double y = t < 2222   ? cubic(x, -1.1063814, -1.34811020, 2.18555832, -0.20219683)
                   : t < 4000 ? cubic(x, -0.9549476, -1.37418593, 2.09137015, -0.16748867)
                              : cubic(x, 3.0817580, -5.87338670, 3.75112997, -0.37001483);
  const double big_x = x / y, big_z = (1 - x - y) / y;  // CIE XYZ with Y = 1
  Rgb color(static_cast<float>(3.2404542 * big_x - 1.5371385 - 0.4985314 * big_z),
            static_cast<float>(-0.9692660 * big_x + 1.8760108 + 0.0415560 * big_z),
            static_cast<float>(0.0556434 * big_x - 0.2040259 + 1.0572252 * big_z));
  for (int c = 0; c < 3; ++c) color[c] = std::max(color[c], 0.0f);
  return color / luminance(color);
}

Rgb LightEmission::color() const {
  return temperature ? radiance * black_body_color(*temperature) : radiance;
}

float LightEmission::strength(double frame) const {
  return intensity.at(frame) * std::exp2(exposure.at(frame));
}

}  // namespace pelage
