// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>

#include "base/vector.h"

namespace pelage {

/// Optical description of a fibre: a circular dielectric cylinder of radius 1 with a concentric scattering
/// core of the same index, the medulla. Lengths and coefficients are in units of the fibre's radius.
struct TracedFibre {
  float eta = 1.55f;
  float layers =
      0;  ///< count of cuticle layers, see cuticle_reflectance(); 0: no layers, one smooth interface
  float medulla = 0;     ///< kappa: radius of the core / radius of the fibre
  float scattering = 0;  ///< sigma_ms: scattering coefficient of the medulla
  float anisotropy = 0;  ///< g of Henyey-Greenstein
};

/// One light path through a fibre, or off its surface.
struct FibrePath {
  V3f wi{0};               ///< exit direction; x is along the fibre, wo in the half plane of x and +y
  int reflections = 0;     ///< internal reflections; if `entered`: 0 for TT, 1 for TRT
  bool entered = false;    ///< false: reflected by the surface (R)
  bool scattered = false;  ///< whether the medulla scattered the light at least once
  float cortex = 0;        ///< length travelled outside the medulla, inside the fibre
  float core = 0;          ///< length travelled in the medulla
};

/// Traces one random light path through a fibre, with a random choice at every interface and in the medulla.
/// Such paths are the reference for the models. Nothing is absorbed, so every path leaves the fibre with
/// weight 1. For light that arrives at offset `h` from a direction wo with inclination theta_o, the
/// distribution of wi is therefore the scattering function of a fibre that absorbs nothing. To include
/// absorption with the coefficients sigma_ca (cortex) and sigma_ma (medulla), multiply the weight by
/// exp(-sigma_ca cortex - sigma_ma core). The path is a function of the arguments only; `number`
/// distinguishes paths with the same seed.
FibrePath trace_fibre(const TracedFibre& fibre, float sin_theta_o, float h, uint64_t seed, uint64_t number);

}  // namespace pelage
