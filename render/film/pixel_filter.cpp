// SPDX-License-Identifier: Apache-2.0
#include "render/film/pixel_filter.h"

#include <algorithm>
#include <cmath>
#include <numbers>

namespace pelage {
namespace {

constexpr size_t kTableSteps = 1024;

constexpr float kBlackmanHarrisRadius = 1.5f;

// Minimum 4-term window [Harris78, table I]; its integral over [-radius, radius] is 2 radius kTerms[0].
constexpr double kTerms[4] = {0.35875, 0.48829, 0.14128, 0.01168};
constexpr float kFrequency = std::numbers::pi_v<float> / kBlackmanHarrisRadius;

/// The window at angle x. `c`: cos x. cos 2x and cos 3x are polynomials of cos x.
float window(float c) {
  return static_cast<float>(kTerms[0]) + static_cast<float>(kTerms[1]) * c +
         static_cast<float>(kTerms[2]) * (2 * c * c - 1) +
         static_cast<float>(kTerms[3]) * c * (4 * c * c - 3);
}

}  // namespace

FilterSampler::FilterSampler(PixelFilter filter) {
  if (filter == PixelFilter::kBox) return;
  inverse_.resize(kTableSteps + 1);
  for (size_t i = 0; i <= kTableSteps; ++i) {
    const double u = static_cast<double>(i) / kTableSteps;
    double low = -filter_radius(filter), high = filter_radius(filter);
    for (int step = 0; step < 50; ++step) {
      const double middle = 0.5 * (low + high);
      (filter_integral(filter, middle) < u ? low : high) = middle;
    }
    inverse_[i] = static_cast<float>(0.5 * (low + high));
  }
}

float FilterSampler::axis(float u) const {
  if (inverse_.empty()) return u - 0.5f;
  const float scaled = u * static_cast<float>(kTableSteps);
  const size_t step = std::min(static_cast<size_t>(scaled), kTableSteps - 1);
  const float t = scaled - static_cast<float>(step);
  return inverse_[step] * (1 - t) + inverse_[step + 1] * t;
}

float filter_radius(PixelFilter filter) { return filter == PixelFilter::kBox ? 0.5f : kBlackmanHarrisRadius; }

float filter_value(PixelFilter filter, float distance) {
  if (std::abs(distance) > filter_radius(filter)) return 0;
  if (filter == PixelFilter::kBox) return 1;
  return window(std::cos(kFrequency * distance));
}

std::array<float, 3> filter_around(PixelFilter filter, float from_centre) {
  if (filter == PixelFilter::kBox) return {0, 1, 0};
  // Neighbouring pixels are a third of the period apart: cos(x +- 2/3 pi) = -cos(x) / 2 -+ sin(x) sqrt(3)
  // / 2.
  const float x = kFrequency * from_centre, c = std::cos(x);
  const float s = std::copysign(std::sqrt(std::max(0.0f, 1 - c * c)), x);
  constexpr float kHalfRoot3 = 0.5f * std::numbers::sqrt3_v<float>;
  return {window(-0.5f * c - kHalfRoot3 * s), window(c), window(-0.5f * c + kHalfRoot3 * s)};
}

double filter_integral(PixelFilter filter, double x) {
  const double radius = filter_radius(filter), inside = std::clamp(x, -radius, radius);
  if (filter == PixelFilter::kBox) return inside + 0.5;
  double sum = kTerms[0] * inside;
  for (int k = 1; k < 4; ++k) {
    const double frequency = k * std::numbers::pi / radius;
    sum += kTerms[k] * std::sin(frequency * inside) / frequency;
  }
  return 0.5 + sum / (2 * radius * kTerms[0]);
}

}  // namespace pelage
