// SPDX-License-Identifier: Apache-2.0
#include "render/fibre/cone_shell.h"

#include "render/sampling/warp.h"

namespace pelage {

namespace {

constexpr float kRadians = kPi / 180;

/// 1 - cos of an angle in [0, pi] without cancellation.
float one_minus_cos(float cosine, float sine) {
  return cosine > 0 ? sine * sine / (1.0f + cosine) : 1.0f - cosine;
}

}  // namespace

ShellShape::ShellShape(float half_width_degrees, float tilt_degrees)
    : half_width(half_width_degrees * kRadians),
      cos_width(std::max(0.0f, std::cos(half_width))),
      sin_width(std::sin(half_width)),
      cos_tilt(std::cos(tilt_degrees * kRadians)),
      sin_tilt(std::sin(tilt_degrees * kRadians)) {}

ConeShell::ConeShell(const ShellShape& shape, ShellVariant variant, float sin_theta_o)
    : variant_(variant), below_(shape.half_width), above_(shape.half_width) {
  const float mirror_cos = -std::clamp(sin_theta_o, -1.0f, 1.0f);
  const float mirror_sin = std::sqrt((1.0f - mirror_cos) * (1.0f + mirror_cos));
  cos_mid_ = mirror_cos * shape.cos_tilt - mirror_sin * shape.sin_tilt;
  sin_mid_ = mirror_sin * shape.cos_tilt + mirror_cos * shape.sin_tilt;
  if (sin_mid_ < 0.0f) {  // tilted past a pole
    cos_mid_ = std::copysign(1.0f, cos_mid_);
    sin_mid_ = 0.0f;
  }

  // Inner and outer cone by angle addition; an angle outside [0, pi] has a negative sine.
  const float inner_sin = sin_mid_ * shape.cos_width - cos_mid_ * shape.sin_width;
  const float outer_sin = sin_mid_ * shape.cos_width + cos_mid_ * shape.sin_width;
  const float inner_cos = cos_mid_ * shape.cos_width + sin_mid_ * shape.sin_width;
  const float outer_cos = cos_mid_ * shape.cos_width - sin_mid_ * shape.sin_width;
  const bool literal = variant == ShellVariant::kLiteral;
  // Integral of the literal weight over z, with cos P - cos Q as a product of sines:
  // (W sin mid + sin(T_max + T_min - T_mid) sin W) / 2, W = T_max - T_min.
  float weight_integral;
  if (inner_sin < 0.0f) {  // cut at T: Theta_min = 0
    half_range_ = 0.5f * one_minus_cos(outer_cos, outer_sin);
    center_ = 1.0f - half_range_;
    if (literal) below_ = std::atan2(sin_mid_, cos_mid_);
    weight_integral = 0.5f * ((below_ + above_) * sin_mid_ + shape.sin_width * outer_sin);
  } else if (outer_sin < 0.0f) {  // cut at -T: Theta_max = pi
    half_range_ = 0.5f * one_minus_cos(-inner_cos, inner_sin);
    center_ = half_range_ - 1.0f;
    if (literal) above_ = std::atan2(sin_mid_, -cos_mid_);
    weight_integral = 0.5f * ((below_ + above_) * sin_mid_ + shape.sin_width * inner_sin);
  } else {
    half_range_ = sin_mid_ * shape.sin_width;
    center_ = cos_mid_ * shape.cos_width;
    weight_integral = sin_mid_ * (shape.half_width + shape.sin_width * shape.cos_width);
  }
  inverse_half_range_ = 1.0f / half_range_;
  scale_ = literal ? 1.0f / (2.0f * kPi * weight_integral) : inverse_half_range_ / (kPi * kPi);
}

float ConeShell::sample_literal(float xi) const {
  // G(psi) = sin mid (psi/2 + sin(2 psi)/4) - cos mid cos(2 psi)/4, psi = Theta - Theta_mid; G' >= 0 in the
  // shell. In double because G of a narrow shell hardly changes across it.
  const double cos_mid = cos_mid_, sin_mid = sin_mid_;
  double low = -below_, high = above_;
  const auto integral = [&](double psi, double s, double c) {
    return sin_mid * 0.5 * (psi + s * c) + cos_mid * 0.5 * s * s;
  };
  const double g_low = integral(low, std::sin(low), std::cos(low));
  const double g_high = integral(high, std::sin(high), std::cos(high));
  const double target = g_low + xi * (g_high - g_low);
  double psi = low + xi * (high - low);
  double s = std::sin(psi), c = std::cos(psi);
  for (int i = 0; i < 32; ++i) {
    const double error = integral(psi, s, c) - target;
    (error > 0 ? high : low) = psi;
    const double slope = c * (sin_mid * c + cos_mid * s);
    double next = psi - error / slope;
    if (!(next > low && next < high)) next = 0.5 * (low + high);
    const double step = next - psi;
    psi = next;
    s = std::sin(psi);
    c = std::cos(psi);
    if (std::abs(step) < 1e-9) break;
  }
  return static_cast<float>(cos_mid * c - sin_mid * s);
}

ShellPoint ConeShell::sample(ShellSampler sampler, float xi) const {
  if (sampler == ShellSampler::kMatched) {
    const float z = sample(xi);
    return {z, 2.0f * kPi * density(z)};
  }
  const bool tent = sampler == ShellSampler::kTent;
  const float u = tent ? tent_sample(xi) : 2.0f * xi - 1.0f;
  return {center_ + half_range_ * u, (tent ? tent_pdf(u) : 0.5f) * inverse_half_range_};
}

}  // namespace pelage
