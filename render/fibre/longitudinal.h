// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cmath>

#include "render/sampling/warp.h"

namespace pelage {

/// Returns I0(x) exp(exponent) for x >= 0, where I0 is the modified Bessel function of order 0. Uses
/// polynomials with a relative error of 2e-7 [Abramowitz64, 9.8.1 and 9.8.2]. For large x, the polynomial
/// gives exp(-x) I0(x), which is multiplied by exp(exponent + x). Therefore I0(x), which may be too large for
/// a float, is never computed.
inline float bessel_i0_exp(float x, float exponent) {
  if (x < 3.75f) {
    const float t = (x / 3.75f) * (x / 3.75f);
    const float i0 =
        1 + t * (3.5156229f +
                 t * (3.0899424f + t * (1.2067492f + t * (0.2659732f + t * (0.0360768f + t * 0.0045813f)))));
    return i0 * std::exp(exponent);
  }
  const float t = 3.75f / x;
  const float scaled =
      0.39894228f +
      t * (0.01328592f +
           t * (0.00225319f +
                t * (-0.00157565f +
                     t * (0.00916281f +
                          t * (-0.02057706f + t * (0.02635537f + t * (-0.01647633f + t * 0.00392377f)))))));
  return scaled / std::sqrt(x) * std::exp(exponent + x);
}

/// The energy-conserving longitudinal function of [dEon11, equation 7]. It is a density with respect to
/// cos(theta_i) d theta_i, the longitudinal part of solid angle:
///
///   M(v; theta_i, theta_o) = I0(cos ti cos to / v) exp(-sin ti sin to / v) / (2 v sinh(1 / v)),
///
/// ti and to are theta_i and theta_o; v is the variance in radians squared. The integral of M cos(theta_i) d
/// theta_i is 1 for every theta_o and v. The peak of M is near theta_i = -theta_o.
class LongitudinalLobe {
 public:
  LongitudinalLobe() : LongitudinalLobe(1) {}
  explicit LongitudinalLobe(float variance)
      : variance_(std::max(variance, kNarrowest)),
        inverse_(1 / variance_),
        tail_(std::exp(-2 * inverse_)),
        scale_(inverse_ / (1 - tail_)) {
    if (variance_ > 1) scale_ = inverse_ / -std::expm1(-2 * inverse_);
  }

  float variance() const { return variance_; }

  /// Returns M from the sines and cosines of theta_i and theta_o.
  float density(float sin_i, float cos_i, float sin_o, float cos_o) const {
    // below_peak is (cos ti cos to - sin ti sin to - 1) / v. It is computed from the small differences s and
    // c, because subtracting the products would lose the precision that narrow lobes need.
    const float s = sin_i + sin_o, c = cos_i - cos_o;
    const float below_peak = -0.5f * (s * s + c * c) * inverse_;
    const float x = cos_i * cos_o * inverse_;
    return scale_ * bessel_i0_exp(x, below_peak - x);
  }

  /// Returns sin theta_i, sampled with the density M with respect to sin theta_i [dEon13]. `u`: two random
  /// numbers in [0, 1). u.y may be less well stratified than u.x.
  float sample(const V2f& u, float sin_o, float cos_o) const {
    const float below_one = std::min(2.0f, -variance_ * std::log(u.x + (1 - u.x) * tail_));
    const float c = 1 - below_one, s = std::sqrt(std::max(0.0f, below_one * (2 - below_one)));
    const float z = -c * sin_o + s * std::cos(2 * kPi * u.y) * cos_o;
    return std::clamp(z, -1.0f, 1.0f);
  }

 private:
  static constexpr float kNarrowest = 1e-7f;  // min variance, rad^2: a deviation of about 1/55 degree
  float variance_, inverse_, tail_, scale_;
};

}  // namespace pelage
