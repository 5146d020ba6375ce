// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "render/fibre/azimuthal.h"
#include "render/fibre/separable_bsdf.h"
#include "render/material/fibre_params.h"

namespace pelage {

using DeonBsdf = SeparableBsdf<WrappedGaussian>;

/// Azimuthal roughness (beta_n) that models without this parameter pass to the fit of [Chiang16].
inline constexpr float kColorRoughness = 0.3f;

/// Material constants of the energy-conserving model of [dEon11]: the lobes of Marschner with a normalised
/// longitudinal function, Gaussian detectors around the fibre, and one lobe for all longer paths.
/// Attenuations are evaluated at theta_o instead of theta_d. At the peaks of the lobes, the two angles are
/// equal. In this way energy is exact, and lobes are sampled exactly.
///
/// The far field is the average over h.
class DeonMaterial : public SeparableMaterial<WrappedGaussian> {
 public:
  explicit DeonMaterial(const DeonParams& params);
};

}  // namespace pelage
