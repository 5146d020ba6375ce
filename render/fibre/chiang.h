// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "render/fibre/azimuthal.h"
#include "render/fibre/separable_bsdf.h"
#include "render/material/fibre_params.h"

namespace pelage {

using ChiangBsdf = SeparableBsdf<TrimmedLogistic>;

/// Material constants of the near-field model of [Chiang16]: lobes R, TT and TRT with d'Eon's longitudinal
/// function and a trimmed logistic as azimuthal function, and one lobe for all longer paths.
///
/// alpha is the tilt of the cuticle's scales, whose free edges point to the tip. Multiples of alpha are added
/// to theta_o: +2 alpha for R, -alpha for TT and -4 alpha for TRT. The tangent T points from root to tip.
class ChiangMaterial : public SeparableMaterial<TrimmedLogistic> {
 public:
  explicit ChiangMaterial(const ChiangParams& params);
};

/// Returns the variance of the R lobe, in radians squared, for the longitudinal roughness [Chiang16, equation
/// 7].
float chiang_variance(float beta_m);
/// Returns the scale of the logistic, in radians, for the azimuthal roughness [Chiang16, equation 8].
float chiang_scale(float beta_n);

}  // namespace pelage
