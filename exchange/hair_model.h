// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>

#include "exchange/export_notes.h"
#include "render/material/material.h"

namespace pelage {

/// A fibre as the model of [Chiang16] describes it, which most renderers have.
struct HairModel {
  Rgb absorption{0};    ///< per radius
  float eta = 1.55f;    ///< index of refraction
  float beta_m = 0.3f;  ///< longitudinal roughness, 0 to 1
  float beta_n = 0.3f;  ///< azimuthal roughness, 0 to 1
  float alpha = 2;      ///< tilt of the cuticle's scales in degrees, with the sign of ChiangParams::alpha

  /// Variance of the longitudinal lobe R, and scale of the logistic azimuthal lobes without the factor
  /// sqrt(pi / 8) [Chiang16, eq. 7 and 8].
  float longitudinal_variance() const;
  float azimuthal_scale() const;
};

/// Returns the parameters that make a fibre most similar to a material. `chiang` is exact. `deon` and
/// `marschner` keep their absorption and get the roughness whose lobes are as wide. The other models keep
/// their colour: they get the absorption at which dense Chiang fibres have this colour. `color`: of the
/// material, for models whose absorption follows from it. Adds notes about approximations.
HairModel hair_model(const MaterialParams& material, const Rgb& color, const std::string& name,
                     ExportNotes& notes);

}  // namespace pelage
