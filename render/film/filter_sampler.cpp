// SPDX-License-Identifier: Apache-2.0
// Tested in tests/render/film/film_test.cpp.
#include "render/film/filter_sampler.h"

#include <algorithm>
#include <cmath>
#include <numbers>

namespace pelage {
namespace {

constexpr float kBlackmanHarrisRadius = 1.5f;
constexpr size_t kTableSteps = 1024;

// Minimum 4-term window [Harris78, table I]; its integral over [-radius, radius] is 2 radius kTerms[0].
constexpr double kTerms[4] = {0.35875, 0.48829, 0.14128, 0.01168};

double blackman_harris_cumulative(double x, double radius) {
  double sum = kTerms[0] * x;
  for (int k = 1; k < 4; ++k) {
    const double frequency = k * std::numbers::pi / radius;
    sum += kTerms[k] * std::sin(frequency * x) / frequency;
  }
  return 0.5 + sum / (2 * radius * kTerms[0]);
}

}  // namespace

FilterSampler::FilterSampler(PixelFilter filter)
    : filter_(filter), radius_(filter == PixelFilter::kBox ? 0.5f : kBlackmanHarrisRadius) {
  if (filter_ == PixelFilter::kBox) return;
  inverse_.resize(kTableSteps + 1);
  for (size_t i = 0; i <= kTableSteps; ++i) {
    const double u = static_cast<double>(i) / kTableSteps;
    double low = -radius_, high = radius_;
    for (int step = 0; step < 50; ++step) {
      const double middle = 0.5 * (low + high);
      (cumulative(middle) < u ? low : high) = middle;
    }
    inverse_[i] = static_cast<float>(0.5 * (low + high));
  }
}

double FilterSampler::cumulative(double x) const {
  const double inside = std::clamp(x, -double{radius_}, double{radius_});
  if (filter_ == PixelFilter::kBox) return inside + 0.5;
  return blackman_harris_cumulative(inside, radius_);
}

float FilterSampler::axis(float u) const {
  if (inverse_.empty()) return u - 0.5f;
  const float scaled = u * static_cast<float>(kTableSteps);
  const size_t step = std::min(static_cast<size_t>(scaled), kTableSteps - 1);
  const float t = scaled - static_cast<float>(step);
  return inverse_[step] * (1 - t) + inverse_[step + 1] * t;
}

}  // namespace pelage
