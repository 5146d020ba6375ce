// SPDX-License-Identifier: Apache-2.0
#include "rib/syntax/rib_transform.h"

#include <algorithm>
#include <cmath>

namespace pelage {

M44f RibTransform::at(double time) const {
  const auto after = std::upper_bound(samples_.begin(), samples_.end(), time,
                                      [](double t, const auto& sample) { return t < sample.first; });
  if (after == samples_.begin()) return samples_.front().second;
  if (after == samples_.end()) return samples_.back().second;
  const auto& [t0, a] = *(after - 1);
  const auto& [t1, b] = *after;
  const auto t = static_cast<float>((time - t0) / (t1 - t0));
  return a * (1 - t) + b * t;
}

RibTransform RibTransform::after(const RibTransform& first) const {
  if (!moves() && !first.moves()) return RibTransform(first.samples_[0].second * samples_[0].second);
  std::vector<double> times;
  for (const RibTransform* one : {this, &first}) {
    for (const auto& sample : one->samples_) {
      if (one->moves()) times.push_back(sample.first);
    }
  }
  std::sort(times.begin(), times.end());
  times.erase(std::unique(times.begin(), times.end()), times.end());
  std::vector<std::pair<double, M44f>> samples;
  for (const double time : times) samples.emplace_back(time, first.at(time) * at(time));
  return RibTransform(std::move(samples));
}

bool is_usable(const RibTransform& transform) {
  return std::all_of(transform.samples().begin(), transform.samples().end(),
                     [](const auto& sample) { return is_usable(sample.second); });
}

bool is_usable(const M44f& matrix) {
  for (const auto& row : matrix.x) {
    for (const float x : row) {
      if (!std::isfinite(x)) return false;
    }
  }
  const auto& m = matrix.x;
  const double det = double(m[0][0]) * (double(m[1][1]) * m[2][2] - double(m[1][2]) * m[2][1]) -
                     double(m[0][1]) * (double(m[1][0]) * m[2][2] - double(m[1][2]) * m[2][0]) +
                     double(m[0][2]) * (double(m[1][0]) * m[2][1] - double(m[1][1]) * m[2][0]);
  return std::isfinite(det) && std::abs(det) > 1e-30;
}

}  // namespace pelage
