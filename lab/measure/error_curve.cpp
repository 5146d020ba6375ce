// SPDX-License-Identifier: Apache-2.0
#include "lab/measure/error_curve.h"

#include <algorithm>
#include <cmath>
#include <utility>

namespace pelage {
namespace {

/// The points that have logarithms, by time.
ErrorCurve usable(ErrorCurve curve) {
  std::erase_if(curve, [](const auto& point) { return !(point.first > 0) || !(point.second > 0); });
  std::sort(curve.begin(), curve.end());
  return curve;
}

}  // namespace

double cpu_s_to(ErrorCurve curve, double error) {
  curve = usable(std::move(curve));
  for (size_t i = 0; i + 1 < curve.size(); ++i) {
    const auto& [from_s, from] = curve[i];
    const auto& [to_s, to] = curve[i + 1];
    if (!(from >= error && error >= to)) continue;
    if (from == to) return from_s;
    const double t = std::log(from / error) / std::log(from / to);
    return from_s * std::pow(to_s / from_s, t);
  }
  return NAN;
}

double error_after(ErrorCurve curve, double cpu_s) {
  curve = usable(std::move(curve));
  for (size_t i = 0; i + 1 < curve.size(); ++i) {
    const auto& [from_s, from] = curve[i];
    const auto& [to_s, to] = curve[i + 1];
    if (!(from_s <= cpu_s && cpu_s <= to_s)) continue;
    if (from_s == to_s) return to;
    return from * std::pow(to / from, std::log(cpu_s / from_s) / std::log(to_s / from_s));
  }
  return NAN;
}

}  // namespace pelage
