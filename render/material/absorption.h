// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "base/vector.h"

namespace pelage {

// All absorption coefficients in this file are per radius of the fibre.

/// Returns the absorption coefficient of hair with these concentrations of the two pigments eumelanin (black,
/// brown) and pheomelanin (red, yellow) [dEon11, after Donner and Jensen].
inline Rgb melanin_absorption(float eumelanin, float pheomelanin) {
  return Rgb(0.419f, 0.697f, 1.37f) * eumelanin + Rgb(0.187f, 0.4f, 1.05f) * pheomelanin;
}

/// Converts the colour of a dense coat to the absorption coefficient of each of its fibres, for fibres with
/// an azimuthal roughness in [0, 1]. This is the fit of [Chiang16, section 4.2]. A single fibre with this
/// absorption looks far lighter than the colour of the coat.
class ColorToAbsorption {
 public:
  explicit ColorToAbsorption(float azimuthal_roughness);
  Rgb operator()(const Rgb& color) const;

 private:
  float inverse_slope_;
};

}  // namespace pelage
