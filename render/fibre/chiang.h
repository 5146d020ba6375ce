// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "render/fibre/azimuthal.h"
#include "render/fibre/separable_material.h"
#include "render/material/fibre_params.h"

namespace pelage {

using ChiangBsdf = SeparableBsdf<TrimmedLogistic>;

/// Material constants of the near-field model of [Chiang16]: lobes R, TT and TRT with the longitudinal
/// function of d'Eon and a trimmed logistic around the fibre, and one lobe for all longer paths.
///
/// The tilt of the cuticle's scales, whose free edges point to the tip, is added to theta_o: +2 alpha for R,
/// -alpha for TT and -4 alpha for TRT, with T from root to tip.
class ChiangMaterial : public SeparableMaterial<TrimmedLogistic> {
 public:
  explicit ChiangMaterial(const ChiangParams& params);
};

/// Variance of the R lobe by longitudinal roughness [Chiang16, equation 7].
float chiang_variance(float beta_m);
/// Scale of the logistic by azimuthal roughness [Chiang16, equation 8].
float chiang_scale(float beta_n);

}  // namespace pelage
