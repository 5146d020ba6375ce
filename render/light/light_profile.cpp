// SPDX-License-Identifier: Apache-2.0
#include "render/light/light_profile.h"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <utility>

namespace pelage {
namespace {

constexpr double kToRadians = std::numbers::pi / 180;
constexpr float kToDegrees = 180 / std::numbers::pi_v<float>;

/// Weights of the values at each angle in the integral of a piecewise linear function * sin(angle).
std::vector<double> vertical_weights(const std::vector<float>& degrees) {
  std::vector<double> weights(degrees.size());
  for (size_t i = 0; i + 1 < degrees.size(); ++i) {
    const double a = degrees[i] * kToRadians, b = degrees[i + 1] * kToRadians;
    const double second = (std::sin(b) - std::sin(a)) / (b - a) - std::cos(b);
    weights[i] += std::cos(a) - std::cos(b) - second;
    weights[i + 1] += second;
  }
  return weights;
}

/// Weights of the values at each angle in the mean of a piecewise linear function.
std::vector<double> horizontal_weights(const std::vector<float>& degrees) {
  if (degrees.size() == 1) return {1};
  std::vector<double> weights(degrees.size());
  const double range = double{degrees.back()} - degrees.front();
  for (size_t i = 0; i + 1 < degrees.size(); ++i) {
    const double half = 0.5 * (double{degrees[i + 1]} - degrees[i]) / range;
    weights[i] += half;
    weights[i + 1] += half;
  }
  return weights;
}

/// Index of the interval of an angle, and the place in the interval, from 0 to 1.
std::pair<size_t, float> interval_of(const std::vector<float>& angles, float angle) {
  if (angles.size() == 1) return {0, 0.0f};
  const auto above = std::upper_bound(angles.begin() + 1, angles.end() - 1, angle);
  const float first = *(above - 1);
  return {static_cast<size_t>(above - 1 - angles.begin()),
          std::clamp((angle - first) / (*above - first), 0.0f, 1.0f)};
}

/// Mirrors a horizontal angle into the range of the file.
float mirrored(const std::vector<float>& horizontal, float angle) {
  const float last = horizontal.back();
  if (horizontal.size() == 1 || last == 360) return angle;
  if (last == 270) return angle < 90 ? 180 - angle : angle > 270 ? 540 - angle : angle;
  if (angle > 180) angle = 360 - angle;
  return last == 90 && angle > 90 ? 180 - angle : angle;
}

}  // namespace

int64_t LightProfile::bytes(const IesPhotometry& ies) {
  return static_cast<int64_t>((ies.vertical.size() + ies.horizontal.size() + ies.candela.size()) *
                              sizeof(float));
}

LightProfile::LightProfile(IesPhotometry ies, MemoryCharge charge)
    : charge_(std::move(charge)), ies_(std::move(ies)) {
  const std::vector<double> by_vertical = vertical_weights(ies_.vertical);
  const std::vector<double> by_horizontal = horizontal_weights(ies_.horizontal);
  double mean = 0;
  for (size_t h = 0; h < by_horizontal.size(); ++h) {
    for (size_t v = 0; v < by_vertical.size(); ++v)
      mean += 0.5 * by_horizontal[h] * by_vertical[v] * ies_.candela[h * by_vertical.size() + v];
  }
  watts_ = static_cast<float>(mean * 4 * std::numbers::pi / kLumensPerWatt);
  for (float& value : ies_.candela) value = static_cast<float>(value / mean);
}

bool LightProfile::is_dark_within(float degrees) const {
  const std::vector<float>& angles = ies_.vertical;
  if (angles.front() >= degrees) return true;
  // Intensities are interpolated up to the first angle that is not within.
  const auto end = std::lower_bound(angles.begin(), angles.end(), degrees);
  const auto count = std::min(static_cast<size_t>(end - angles.begin()) + 1, angles.size());
  for (size_t row = 0; row < ies_.candela.size(); row += angles.size()) {
    const auto first = ies_.candela.begin() + static_cast<std::ptrdiff_t>(row);
    if (std::any_of(first, first + static_cast<std::ptrdiff_t>(count), [](float v) { return v > 0; }))
      return false;
  }
  return true;
}

float LightProfile::factor(const V3f& direction) const {
  const float vertical = std::acos(std::clamp(direction.z, -1.0f, 1.0f)) * kToDegrees;
  if (!(vertical >= ies_.vertical.front() && vertical <= ies_.vertical.back())) return 0;
  const auto [v, t] = interval_of(ies_.vertical, vertical);
  const float turn = std::atan2(-direction.x, -direction.y) * kToDegrees;
  const float horizontal = mirrored(ies_.horizontal, turn < 0 ? turn + 360 : turn);
  const auto [h, s] = interval_of(ies_.horizontal, horizontal);
  const float* row = &ies_.candela[h * ies_.vertical.size() + v];
  const float* next = ies_.horizontal.size() > 1 ? row + ies_.vertical.size() : row;
  return (row[0] * (1 - t) + row[1] * t) * (1 - s) + (next[0] * (1 - t) + next[1] * t) * s;
}

}  // namespace pelage
