// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <algorithm>
#include <array>
#include <cmath>

#include "render/fibre/azimuthal.h"

namespace pelage {

/// Samples theta_h = (theta_i + theta_o) / 2 for a longitudinal lobe. The lobe is a Gaussian of theta_h times
/// the lobe's energy. The energy is a slowly varying function of theta_h that combines attenuation and change
/// of measure. theta_i stays in [-pi/2, pi/2], which truncates the Gaussian.
///
/// Let s in [0, 1] be the cumulative distribution of the truncated Gaussian. The energy is interpolated
/// linearly between a few values of s. The product of the Gaussian and the interpolated energy is sampled
/// exactly, so sample weights vary only because of the interpolation error.
class HalfAngleLobe {
 public:
  HalfAngleLobe() = default;
  /// `center`, `width`: mean and standard deviation of the Gaussian, in radians. `energy(theta_h)` must be at
  /// least 0.
  template <class Energy>
  HalfAngleLobe(float center, float width, float theta_o, Energy&& energy) : center_(center), width_(width) {
    const float low = (0.5f * (theta_o - kPi / 2) - center) / width;
    const float high = (0.5f * (theta_o + kPi / 2) - center) / width;
    below_ = normal_below(low);
    within_ = std::max(0.0f, normal_below(high) - below_);
    if (!(within_ > kMinMass)) return;
    for (int k = 1; k < kPlaces - 1; ++k) {
      const float x = normal_sample(below_ + kPlace[k] * within_);
      energy_[k] = energy(center + width * std::clamp(x, low, high));
    }
    const float min = kMinShare * *std::max_element(energy_.begin(), energy_.end());
    for (float& e : energy_) e = std::max(e, min);
    energy_.front() = energy_[1] * left_at_end(-low);
    energy_.back() = energy_[kPlaces - 2] * left_at_end(high);
    for (int k = 0; k < kPlaces - 1; ++k) mean_ += part(k);
  }

  /// Approximate integral of the Gaussian times the energy. If it is 0, do not sample this lobe.
  float energy() const { return within_ * mean_; }

  /// Returns the density of theta_h, per radian.
  float density(float theta_h) const {
    if (!(mean_ > 0)) return 0;
    const float x = (theta_h - center_) / width_;
    const float s = std::clamp((normal_below(x) - below_) / within_, 0.0f, 1.0f);
    int k = 0;
    while (k < kPlaces - 2 && s >= kPlace[k + 1]) ++k;
    const float t = (s - kPlace[k]) / (kPlace[k + 1] - kPlace[k]);
    const float at = energy_[k] + t * (energy_[k + 1] - energy_[k]);
    return std::exp(-0.5f * x * x) / (std::sqrt(2 * kPi) * width_ * within_) * at / mean_;
  }
  /// Samples theta_h. Requires energy() > 0.
  float sample(float xi) const {
    float rest = xi * mean_;
    int k = 0;
    while (k < kPlaces - 2 && rest >= part(k)) rest -= part(k++);
    const float u = std::min(rest / part(k), 1.0f), a = energy_[k], b = energy_[k + 1];
    const float root = std::sqrt(std::max(0.0f, a * a + u * (b * b - a * a)));
    const float t = a + root > 0 ? u * (a + b) / (a + root) : 0;
    const float s = kPlace[k] + std::min(t, 1.0f) * (kPlace[k + 1] - kPlace[k]);
    return center_ + width_ * normal_sample(below_ + s * within_);
  }

 private:
  static constexpr int kPlaces = 5;
  static constexpr std::array<float, kPlaces> kPlace{0, 0.1f, 0.5f, 0.9f, 1};
  static constexpr float kMinShare = 0.02f;  // min energy, relative to the largest
  static constexpr float kMinMass = 1e-5f;   // with less mass, floats are too inaccurate in the tail

  /// Ratio of the energy at an end to the energy beside the end: 0 at a pole that truncates the Gaussian, 1
  /// where the Gaussian is not truncated. `at`: position of the pole, in deviations from the centre.
  static float left_at_end(float at) { return std::clamp(0.5f * (at - 1), 0.0f, 1.0f); }
  float part(int k) const { return 0.5f * (energy_[k] + energy_[k + 1]) * (kPlace[k + 1] - kPlace[k]); }

  float center_ = 0, width_ = 1;
  float below_ = 0, within_ = 0;  // mass of the Gaussian: below the poles, between them
  std::array<float, kPlaces> energy_{};
  float mean_ = 0;  // mean energy over s
};

}  // namespace pelage
