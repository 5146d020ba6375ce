// SPDX-License-Identifier: Apache-2.0
#include "render/fibre/kajiya_kay.h"

#include "render/fibre/wigner.h"

namespace pelage {
namespace {

/// By the midpoint rule over the range of theta_i where the highlight is not negligible.
float integrate_norm(double theta_o, double exponent) {
  constexpr int kSteps = 400;
  constexpr double kHalfPi = std::numbers::pi / 2;
  const double reach = std::min(kHalfPi, 8 / std::sqrt(exponent));
  const double low = std::max(-kHalfPi, -theta_o - reach), high = std::min(kHalfPi, -theta_o + reach);
  const double step = (high - low) / kSteps;
  double sum = 0;
  for (int i = 0; i < kSteps; ++i) {
    const double theta_i = low + (i + 0.5) * step;
    sum += std::pow(std::max(0.0, std::cos(theta_i + theta_o)), exponent) * std::cos(theta_i);
  }
  return static_cast<float>(2 * std::numbers::pi * sum * step);
}

}  // namespace

KajiyaKayMaterial::KajiyaKayMaterial(const KajiyaKayParams& params)
    : diffuse(
          params.diffuse.value_or(1 - std::max({params.specular.x, params.specular.y, params.specular.z}))),
      specular(params.specular),
      exponent(params.exponent),
      // cos^p x <= exp(-p (1 - cos x)): the lobe of variance 1 / p bounds the highlight.
      proposal(1 / params.exponent) {
  for (int i = 0; i <= kNorms; ++i) norms_[i] = integrate_norm(i * std::numbers::pi / 2 / kNorms, exponent);
}

float KajiyaKayMaterial::specular_norm(float sin_theta_o, float cos_theta_o) const {
  const float x = std::atan2(std::abs(sin_theta_o), cos_theta_o) * (2 / kPi) * kNorms;
  const int i = std::clamp(static_cast<int>(x), 0, kNorms - 1);
  return norms_[i] + (x - static_cast<float>(i)) * (norms_[i + 1] - norms_[i]);
}

KajiyaKayBsdf::KajiyaKayBsdf(const KajiyaKayMaterial& material, const Rgb& color, const FibreFrame& frame)
    : material_(&material),
      frame_(frame),
      diffuse_(color * material.diffuse),
      specular_(material.specular),
      inverse_norm_(1 / material.specular_norm(frame.sin_theta_o(), frame.cos_theta_o())) {
  const Rgb sum = albedo();
  const float max = std::max({sum.x, sum.y, sum.z});
  if (max > 1) {
    diffuse_ /= max;
    specular_ /= max;
  }
  const float d = luminance(diffuse_), s = luminance(specular_);
  diffuse_choice_ = d + s > 0 ? d / (d + s) : 1;
}

FibreValue KajiyaKayBsdf::eval(const V3f& wi) const {
  const FibreAngles a = frame_.angles(wi);
  const float even = a.cos_theta / (kPi * kPi);
  const float cosine = a.cos_theta * frame_.cos_theta_o() - a.sin_theta * frame_.sin_theta_o();
  FibreValue value;
  value[LobeGroup::kDiffuse] = diffuse_ * even;
  if (cosine > 0)
    value[LobeGroup::kPrimary] =
        specular_ * (std::pow(std::min(cosine, 1.0f), material_->exponent) * inverse_norm_);
  const float m =
      material_->proposal.density(a.sin_theta, a.cos_theta, frame_.sin_theta_o(), frame_.cos_theta_o());
  value.pdf = diffuse_choice_ * even + (1 - diffuse_choice_) * m * (0.5f / kPi);
  return value;
}

std::optional<FibreSample> KajiyaKayBsdf::sample(const V3f& u) const {
  float z;
  if (u.z < diffuse_choice_) {
    z = WignerTable::instance().sample(u.y);
  } else {
    const float rest = std::min((u.z - diffuse_choice_) / (1 - diffuse_choice_), kBelowOne);
    z = material_->proposal.sample({u.y, rest}, frame_.sin_theta_o(), frame_.cos_theta_o());
  }
  FibreSample s;
  s.wi = frame_.direction(z, std::sqrt((1 - z) * (1 + z)), kPi * (2 * u.x - 1));
  s.value = eval(s.wi);
  if (!(s.value.pdf > 0)) return std::nullopt;
  return s;
}

}  // namespace pelage
