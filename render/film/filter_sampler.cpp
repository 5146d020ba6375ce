// SPDX-License-Identifier: Apache-2.0
#include "render/film/filter_sampler.h"

#include <algorithm>
#include <cmath>

namespace pelage {
namespace {

constexpr size_t kTableSteps = 1024;

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

}  // namespace pelage
