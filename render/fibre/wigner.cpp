// SPDX-License-Identifier: Apache-2.0
#include "render/fibre/wigner.h"

namespace pelage {

namespace {

constexpr double kPiD = std::numbers::pi;

/// Polar angle t from the end u = -1 with F = xi: t - sin t cos t = pi xi, by Newton's method starting from
/// the limit for small xi. The function is convex and the start is below the root, so every later iterate is
/// above it.
double polar_angle(double xi) {
  double t = std::cbrt(1.5 * kPiD * xi);
  for (int i = 0; i < 60; ++i) {
    const double sine = std::sin(t);
    // 2t - sin 2t loses all precision for small t; its series does not.
    const double x = 2 * t;
    const double left = t > 0.05 ? 0.5 * (x - std::sin(x))
                                 : x * x * x / 12 * (1 - x * x / 20 * (1 - x * x / 42 * (1 - x * x / 72)));
    const double step = (left - kPiD * xi) / (2 * sine * sine);
    t -= step;
    if (std::abs(step) <= 1e-15 * t) break;
  }
  return t;
}

}  // namespace

double wigner_cdf(double u) {
  u = std::clamp(u, -1.0, 1.0);
  return 0.5 + (u * std::sqrt((1 - u) * (1 + u)) + std::asin(u)) / kPiD;
}

const WignerTable& WignerTable::instance() {
  static const WignerTable table;
  return table;
}

WignerTable::WignerTable() {
  for (uint32_t i = 0; i < cells_.size(); ++i) {
    const double begin = std::bit_cast<float>((kFirstCell + i) << kCellShift);
    const double end = std::bit_cast<float>((kFirstCell + i + 1) << kCellShift);
    double value[2], slope[2];
    for (int side = 0; side < 2; ++side) {
      // The last cell is used only at xi = 1/2; beyond it, the other half's curve continues.
      const double xi = side == 0 ? begin : end;
      const double t = xi <= 0.5 ? polar_angle(xi) : kPiD - polar_angle(1 - xi);
      value[side] = 2 * std::sin(t / 2) * std::sin(t / 2);
      slope[side] = kPiD / (2 * std::sin(t)) * (end - begin);
    }
    const double rise = value[1] - value[0];
    cells_[i] = {static_cast<float>(value[0]), static_cast<float>(slope[0]),
                 static_cast<float>(3 * rise - 2 * slope[0] - slope[1]),
                 static_cast<float>(slope[0] + slope[1] - 2 * rise)};
  }
}

}  // namespace pelage
