// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "render/fibre/azimuthal.h"
#include "render/fibre/separable_material.h"
#include "render/material/fibre_params.h"

namespace pelage {

using DeonBsdf = SeparableBsdf<WrappedGaussian>;

/// Azimuthal roughness of the fit of [Chiang16] for models that have no such parameter.
inline constexpr float kColorRoughness = 0.3f;

/// Constants of a material by the energy-conserving model of [dEon11]: the lobes of Marschner with a
/// longitudinal function that is normalised, Gaussian detectors around the fibre, and one lobe for all longer
/// ways. Attenuations are taken at theta_o, which is theta_d at the peaks: energy is exact then, and lobes
/// are drawn exactly.
///
/// The far field is the average over h.
class DeonMaterial : public SeparableMaterial<WrappedGaussian> {
 public:
  explicit DeonMaterial(const DeonParams& params);
};

}  // namespace pelage
