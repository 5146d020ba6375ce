// SPDX-License-Identifier: Apache-2.0
#include "render/fibre/marschner.h"

#include <cmath>

namespace pelage {
namespace {

/// The proposal is a little wider around the fibre, because exit azimuths move with theta_d, and a part of it
/// goes everywhere.
constexpr float kWider = 1.25f;
constexpr float kEverywhere = 0.05f;
/// Where both directions lie along the fibre, 1 / cos^2(theta_d) has no bound.
constexpr float kLeastCosine = 1e-2f;

}  // namespace

MarschnerMaterial::MarschnerMaterial(const MarschnerParams& params)
    : eta_(params.eta),
      scale_(params.variant == MarschnerVariant::kPublished ? 1.0f : 0.5f),
      absorption_(given_absorption(params)),
      azimuthal_(params.azimuthal_width * (kPi / 180)) {
  const float alpha = params.alpha * (kPi / 180), beta = params.beta * (kPi / 180);
  alpha_ = {alpha, -alpha / 2, -3 * alpha / 2};
  beta_ = {beta, beta / 2, 2 * beta};
  for (int p = 0; p < kLobes; ++p) {
    proposal_.longitudinal[p] = LongitudinalLobe(4 * beta_[p] * beta_[p]);
    proposal_.set_tilt(p, -2 * alpha_[p]);
  }
  proposal_.longitudinal[kLobes] = LongitudinalLobe(1);
  proposal_.azimuthal.fill(WrappedGaussian(kWider * params.azimuthal_width * (kPi / 180)));
}

MarschnerBsdf MarschnerMaterial::at(const FibreFrame& frame, float h, const Rgb& absorption) const {
  return {*this, frame, h, absorption_.value_or(absorption)};
}

SeparableBsdf<WrappedGaussian> MarschnerBsdf::proposal(const MarschnerMaterial& material,
                                                       const FibreFrame& frame, float h, const Rgb& sigma) {
  const FibreCrossing crossing(material.eta_, 0, frame.sin_theta_o(), frame.cos_theta_o(), h);
  std::array<Rgb, kFibreLobes> amplitudes =
      attenuations(crossing.reflectance, transmittance(sigma, crossing.leg()));
  amplitudes[3] = kEverywhere * (amplitudes[0] + amplitudes[1] + amplitudes[2]);
  return {material.proposal_,
          frame,
          {crossing.exit_azimuth(0), crossing.exit_azimuth(1), crossing.exit_azimuth(2)},
          amplitudes};
}

MarschnerBsdf::MarschnerBsdf(const MarschnerMaterial& material, const FibreFrame& frame, float h,
                             const Rgb& sigma)
    : material_(&material),
      h_(h),
      sigma_(sigma),
      theta_o_(std::atan2(frame.sin_theta_o(), frame.cos_theta_o())),
      proposal_(proposal(material, frame, h, sigma)) {
  albedo_ = proposal_.albedo() * (2 * material.scale_ / (1 + kEverywhere));
}

FibreValue MarschnerBsdf::eval(const V3f& wi) const {
  const FibreAngles a = proposal_.frame().angles(wi);
  const float theta_i = std::atan2(a.sin_theta, a.cos_theta);
  const float theta_h = 0.5f * (theta_i + theta_o_), theta_d = 0.5f * (theta_o_ - theta_i);
  const float cos_d = std::max(std::cos(theta_d), kLeastCosine);
  const FibreCrossing crossing(material_->eta_, 0, std::sin(theta_d), cos_d, h_);
  const std::array<Rgb, kFibreLobes> amplitudes =
      attenuations(crossing.reflectance, transmittance(sigma_, crossing.leg()));
  const float common = material_->scale_ * a.cos_theta / (cos_d * cos_d);
  std::array<float, MarschnerMaterial::kLobes> d;
  for (int p = 0; p < MarschnerMaterial::kLobes; ++p) {
    const float x = (theta_h - material_->alpha_[p]) / material_->beta_[p];
    const float m = std::exp(-0.5f * x * x) / (std::sqrt(2 * kPi) * material_->beta_[p]);
    d[p] = common * m * material_->azimuthal_.density(wrapped_angle(a.phi - crossing.exit_azimuth(p)));
  }
  FibreValue value;
  value[LobeGroup::kPrimary] = amplitudes[0] * d[0];
  value[LobeGroup::kDiffuse] = amplitudes[1] * d[1];
  value[LobeGroup::kSecondary] = amplitudes[2] * d[2];
  value.pdf = proposal_.eval(a).pdf;
  return value;
}

std::optional<FibreSample> MarschnerBsdf::sample(const V3f& u) const {
  FibreSample s;
  s.wi = proposal_.draw(u);
  s.value = eval(s.wi);
  if (!(s.value.pdf > 0)) return std::nullopt;
  return s;
}

}  // namespace pelage
