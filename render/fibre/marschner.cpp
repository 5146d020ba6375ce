// SPDX-License-Identifier: Apache-2.0
#include "render/fibre/marschner.h"

#include <cmath>

#include "render/fibre/dielectric.h"

namespace pelage {
namespace {

/// Where both directions are along the fibre, 1 / cos^2(theta_d) is unbounded.
constexpr float kMinCosine = 1e-2f;
/// Fraction of all samples that are uniform: far from all peaks the lobes are inaccurate.
constexpr float kEverywhere = 0.01f;
/// Least energy by which lobes are divided: lobes that the poles cut off keep losing light.
constexpr float kMinAlbedo = 0.5f;

/// Energy of one lobe at theta_h, relative to the Gaussian of theta_h and up to a constant factor: d omega
/// has another cos(theta_i), d theta_i is 2 d theta_h. Averaged over channels; like FibreCrossing, but
/// without its angles, because a new point of a strand evaluates it nine times.
float lobe_energy(int lobe, float theta_h, float theta_o, float eta, float h, const Rgb& sigma) {
  const float cos_i = std::max(0.0f, std::cos(2 * theta_h - theta_o));
  const float cos_d = std::max(std::cos(theta_o - theta_h), kMinCosine);
  const float slant = cos_i / cos_d;
  const float cos2_d = cos_d * cos_d, across2 = h * h;
  const float f = dielectric_reflectance(cos_d * std::sqrt(std::max(0.0f, 1 - across2)), eta);
  if (lobe == 0) return f * (slant * slant);
  const float inside2 = eta * eta - 1 + cos2_d;
  const float leg = 2 * eta * std::sqrt(std::max(0.0f, inside2 - across2 * cos2_d)) / inside2;
  const Rgb t = transmittance(sigma, leg);
  const float passed = (1 - f) * (1 - f) / 3 * (slant * slant);
  return lobe == 1 ? passed * (t.x + t.y + t.z) : passed * f * t.dot(t);
}

}  // namespace

MarschnerMaterial::MarschnerMaterial(const MarschnerParams& params)
    : eta_(params.eta),
      is_published_(params.variant == MarschnerVariant::kPublished),
      absorption_(given_absorption(params)),
      azimuthal_(params.azimuthal_width * (kPi / 180)) {
  const float alpha = params.alpha * (kPi / 180), beta = params.beta * (kPi / 180);
  alpha_ = {alpha, -alpha / 2, -3 * alpha / 2};
  beta_ = {beta, beta / 2, 2 * beta};
  scale_.fill(is_published_ ? 1.0f : 0.5f);
  if (params.variant != MarschnerVariant::kConserving) return;
  for (int i = 0; i < kAngles; ++i) {
    scale_[i] = 1 / std::max(white_albedo(kPi * (static_cast<float>(i) / (kAngles - 1) - 0.5f)), kMinAlbedo);
  }
}

float MarschnerMaterial::white_albedo(float theta_o) const {
  constexpr int kAcross = 16, kPlaces = 16;
  float sum = 0;
  for (int p = 0; p < kLobes; ++p) {
    const float low = normal_below((0.5f * (theta_o - kPi / 2) - alpha_[p]) / beta_[p]);
    const float high = normal_below((0.5f * (theta_o + kPi / 2) - alpha_[p]) / beta_[p]);
    for (int k = 0; k < kPlaces; ++k) {  // equal shares of the Gaussian that the poles truncate
      const float place = low + (static_cast<float>(k) + 0.5f) / kPlaces * (high - low);
      const float theta_h = alpha_[p] + beta_[p] * normal_sample(place);
      for (int i = 0; i < kAcross; ++i) {
        const float h = (static_cast<float>(i) + 0.5f) / kAcross;
        sum += (high - low) * lobe_energy(p, theta_h, theta_o, eta_, h, Rgb(0));
      }
    }
  }
  return 2 * sum / (kAcross * kPlaces);  // d theta_i is 2 d theta_h
}

float MarschnerMaterial::scale(float theta_o) const {
  const float at = std::clamp((theta_o / kPi + 0.5f) * (kAngles - 1), 0.0f, kAngles - 1.001f);
  const auto i = static_cast<size_t>(at);
  return scale_[i] + (at - static_cast<float>(i)) * (scale_[i + 1] - scale_[i]);
}

MarschnerBsdf MarschnerMaterial::at(const FibreFrame& frame, float h, const Rgb& absorption) const {
  return {*this, frame, h, absorption_.value_or(absorption)};
}

MarschnerBsdf::MarschnerBsdf(const MarschnerMaterial& material, const FibreFrame& frame, float h,
                             const Rgb& sigma)
    : material_(&material),
      frame_(frame),
      h_(h),
      sigma_(sigma),
      theta_o_(std::atan2(frame.sin_theta_o(), frame.cos_theta_o())),
      scale_(material.scale(theta_o_)) {
  float total = 0;
  for (int p = 0; p < kLobes; ++p) {
    lobes_[p] = HalfAngleLobe(material.alpha_[p], material.beta_[p], theta_o_, [&](float theta_h) {
      return lobe_energy(p, theta_h, theta_o_, material.eta_, h_, sigma_);
    });
    total += choice_[p] = lobes_[p].energy();
  }
  for (float& c : choice_) c = total > 0 ? c * (1 - kEverywhere) / total : 0;
}

MarschnerBsdf::Crossing MarschnerBsdf::crossing(float theta_d) const {
  const float cos_d = std::max(std::cos(theta_d), kMinCosine);
  return {FibreCrossing(material_->eta_, 0, std::sin(theta_d), cos_d, h_), cos_d};
}

FibreValue MarschnerBsdf::eval(const V3f& wi) const {
  const FibreAngles a = frame_.angles(wi);
  const float theta_i = std::atan2(a.sin_theta, a.cos_theta);
  const float theta_h = 0.5f * (theta_i + theta_o_);
  const Crossing c = crossing(0.5f * (theta_o_ - theta_i));
  const std::array<Rgb, kFibreLobes> amplitudes =
      attenuations(c.geometry.reflectance, transmittance(sigma_, c.geometry.leg()));
  const float common = scale_ * a.cos_theta / (c.cos_d * c.cos_d);
  // d theta_h / d omega without d phi; at the poles themselves there is no density.
  const float measure = 0.5f / std::max(a.cos_theta, 1e-6f);
  std::array<float, kLobes> d;
  float pdf = 0;
  for (int p = 0; p < kLobes; ++p) {
    const float x = (theta_h - material_->alpha_[p]) / material_->beta_[p];
    const float m = std::exp(-0.5f * x * x) / (std::sqrt(2 * kPi) * material_->beta_[p]);
    const float n = material_->azimuthal_.density(wrapped_angle(a.phi - c.geometry.exit_azimuth(p)));
    d[p] = common * m * n;
    pdf += choice_[p] * lobes_[p].density(theta_h) * n;
  }
  FibreValue value;
  value[LobeGroup::kPrimary] = amplitudes[0] * d[0];
  value[LobeGroup::kDiffuse] = amplitudes[1] * d[1];
  value[LobeGroup::kSecondary] = amplitudes[2] * d[2];
  value.pdf = pdf * measure + uniform_share() * (0.25f / kPi);
  return value;
}

float MarschnerBsdf::uniform_share() const { return 1 - (choice_[0] + choice_[1] + choice_[2]); }

std::optional<FibreSample> MarschnerBsdf::sample(const V3f& u) const {
  int p = 0;
  float rest = u.z;
  while (p < kLobes && rest >= choice_[p]) rest -= choice_[p++];
  FibreSample s;
  if (p == kLobes) {
    s.wi = uniform_direction({u.x, u.y});
  } else {
    const float theta_h = lobes_[p].sample(u.y);
    const float theta_i = std::clamp(2 * theta_h - theta_o_, -kPi / 2, kPi / 2);
    const float phi =
        crossing(theta_o_ - theta_h).geometry.exit_azimuth(p) + material_->azimuthal_.sample(u.x);
    s.wi = frame_.direction(std::sin(theta_i), std::cos(theta_i), phi);
  }
  s.value = eval(s.wi);
  if (!(s.value.pdf > 0)) return std::nullopt;
  return s;
}

Rgb MarschnerBsdf::albedo() const {
  const FibreCrossing at_view(material_->eta_, 0, frame_.sin_theta_o(), frame_.cos_theta_o(), h_);
  const std::array<Rgb, kFibreLobes> a =
      attenuations(at_view.reflectance, transmittance(sigma_, at_view.leg()));
  return (a[0] + a[1] + a[2]) * (material_->is_published_ ? 2.0f : 1.0f);
}

}  // namespace pelage
