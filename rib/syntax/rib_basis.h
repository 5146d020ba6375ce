// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <optional>
#include <string_view>

#include "base/vector.h"

namespace pelage {

/// Basis of cubic curves: the position at t in a segment is [t^3 t^2 t 1] matrix [P0 P1 P2 P3]^T, and the
/// first points of neighbouring segments are `step` points apart [RISPEC 3.2, request Basis].
struct RibBasis {
  enum class Kind { kBezier, kBSpline, kCatmullRom, kOther };
  Kind kind = Kind::kBezier;
  M44f matrix;
  int step = 3;

  /// Returns the basis "bezier", "b-spline", "catmull-rom", "hermite" or "power"; nullopt for other names.
  static std::optional<RibBasis> named(std::string_view name);
  /// Returns the number of segments of a cubic curve of `points` points; 0 when they do not form whole
  /// segments.
  uint32_t segments(uint32_t points, bool periodic) const;
  /// Returns the weights of a segment's four points at t, for the position or the derivative.
  std::array<float, 4> weights(float t) const;
  std::array<float, 4> derivative_weights(float t) const;
};

}  // namespace pelage
