// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "base/vector.h"

namespace pelage {

// Absorption coefficients per radius of the fibre.

/// Absorption by the two pigments of hair, given concentrations of eumelanin (black, brown) and pheomelanin
/// (red, yellow) [dEon11, after Donner and Jensen].
inline Rgb melanin_absorption(float eumelanin, float pheomelanin) {
  return Rgb(0.419f, 0.697f, 1.37f) * eumelanin + Rgb(0.187f, 0.4f, 1.05f) * pheomelanin;
}

/// The fit that converts the colour of a mass of fibres to the absorption of a single one, for an azimuthal
/// roughness in [0, 1] [Chiang16, section 4.2]. A single fibre with this absorption looks far lighter than
/// the colour.
class ColorToAbsorption {
 public:
  explicit ColorToAbsorption(float azimuthal_roughness);
  Rgb operator()(const Rgb& color) const;

 private:
  float inverse_slope_;
};

}  // namespace pelage
