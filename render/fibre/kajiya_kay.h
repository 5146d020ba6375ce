// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <optional>

#include "render/fibre/fibre_frame.h"
#include "render/fibre/fibre_value.h"
#include "render/fibre/longitudinal.h"
#include "render/material/fibre_params.h"

namespace pelage {

/// Constants of a Kajiya-Kay material.
class KajiyaKayMaterial {
 public:
  explicit KajiyaKayMaterial(const KajiyaKayParams& params);

  float diffuse;  ///< albedo; by default 1 minus the max component of `specular`
  Rgb specular;
  float exponent;
  LongitudinalLobe proposal;  ///< density for sampling the highlight; a constant multiple of this density is
                              ///< an upper bound of the highlight

  /// Returns the normalisation of the highlight, K_p(theta_o) = 2 pi times the integral of max(0, cos(theta_i
  /// + theta_o))^p cos(theta_i) d theta_i, where p is the exponent.
  float specular_norm(float sin_theta_o, float cos_theta_o) const;

 private:
  static constexpr int kNorms = 512;
  std::array<float, kNorms + 1> norms_;  // over |theta_o| from 0 to pi / 2
};

/// A diffuse term A_d cos(theta_i) / pi^2, and the highlight A_s max(0, cos(theta_i + theta_o))^p / K_p of
/// [KajiyaKay89, section 4.3], normalised so that A_d and A_s are albedos. Albedos whose sum exceeds one in a
/// channel are scaled down together. Both terms are uniform around the fibre. `material` must outlive this
/// object.
class KajiyaKayBsdf {
 public:
  KajiyaKayBsdf(const KajiyaKayMaterial& material, const Rgb& color, const FibreFrame& frame);

  FibreValue eval(const V3f& wi) const;
  /// u.x selects the azimuth, u.y the inclination. u.z selects the lobe and, for the highlight, also affects
  /// the inclination.
  std::optional<FibreSample> sample(const V3f& u) const;
  Rgb albedo() const { return diffuse_ + specular_; }

 private:
  const KajiyaKayMaterial* material_;
  FibreFrame frame_;
  Rgb diffuse_, specular_;
  float inverse_norm_;
  float diffuse_choice_;
};

}  // namespace pelage
