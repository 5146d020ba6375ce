// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <algorithm>
#include <cmath>

#include "render/sampling/warp.h"

namespace pelage {

/// The logistic distribution with mean 0 and the given scale (radians), truncated to [-pi, pi] and normalised
/// there [Chiang16, section 4.1].
class TrimmedLogistic {
 public:
  TrimmedLogistic() : TrimmedLogistic(1) {}
  explicit TrimmedLogistic(float scale)
      : scale_(scale),
        inverse_(1 / scale),
        below_(1 / (1 + std::exp(kPi * inverse_))),
        kept_(1 - 2 * below_) {
    height_ = inverse_ / kept_;
  }

  /// Returns the density per radian at x in [-pi, pi].
  float density(float x) const {
    const float e = std::exp(-std::abs(x) * inverse_);
    return height_ * e / ((1 + e) * (1 + e));
  }
  float sample(float xi) const {
    const float c = xi * kept_ + below_;
    return std::clamp(-scale_ * std::log(1 / c - 1), -kPi, kPi);
  }

 private:
  float scale_, inverse_, below_, kept_, height_;
};

/// Returns the inverse of the error function at x in (-1, 1), with a relative error of 4e-7 [Giles11, single
/// precision].
inline float inverse_erf(float x) {
  float w = -std::log((1 - x) * (1 + x));
  float p;
  if (w < 5) {
    w -= 2.5f;
    p = 2.81022636e-08f;
    p = 3.43273939e-07f + p * w;
    p = -3.5233877e-06f + p * w;
    p = -4.39150654e-06f + p * w;
    p = 0.00021858087f + p * w;
    p = -0.00125372503f + p * w;
    p = -0.00417768164f + p * w;
    p = 0.246640727f + p * w;
    p = 1.50140941f + p * w;
  } else {
    w = std::sqrt(w) - 3;
    p = -0.000200214257f;
    p = 0.000100950558f + p * w;
    p = 0.00134934322f + p * w;
    p = -0.00367342844f + p * w;
    p = 0.00573950773f + p * w;
    p = -0.0076224613f + p * w;
    p = 0.00943887047f + p * w;
    p = 1.00167406f + p * w;
    p = 2.83297682f + p * w;
  }
  return p * x;
}
/// Returns the xi-quantile of the standard normal distribution, for xi in [0, 1).
inline float normal_sample(float xi) {
  constexpr float kFarthest = 1 - 0x1p-24f;
  return std::numbers::sqrt2_v<float> * inverse_erf(std::clamp(2 * xi - 1, -kFarthest, kFarthest));
}
/// Returns the probability that a standard normal variable is less than x.
inline float normal_below(float x) { return 0.5f * std::erfc(-x * (1 / std::numbers::sqrt2_v<float>)); }

/// The normal distribution with mean 0 and the given standard deviation (radians), wrapped around the circle:
/// the detector of [dEon11] and the azimuthal lobe of [Yan17]. Accurate for deviations up to 2 radians.
class WrappedGaussian {
 public:
  WrappedGaussian() : WrappedGaussian(1) {}
  explicit WrappedGaussian(float deviation)
      : deviation_(deviation),
        half_inverse_square_(0.5f / (deviation * deviation)),
        height_(1 / (deviation * std::sqrt(2 * kPi))),
        turns_(deviation < 0.5f ? 0
               : deviation < 1  ? 1
                                : 2) {}

  /// Returns the density per radian at x in [-pi, pi].
  float density(float x) const {
    float sum = 0;
    for (int k = -turns_; k <= turns_; ++k) {
      const float from = x + 2 * kPi * static_cast<float>(k);
      sum += std::exp(-half_inverse_square_ * from * from);
    }
    return height_ * sum;
  }
  float sample(float xi) const { return deviation_ * normal_sample(xi); }

 private:
  float deviation_, half_inverse_square_, height_;
  int turns_;  // number of windings that density() sums to each side
};

}  // namespace pelage
