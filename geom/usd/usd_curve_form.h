// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "geom/strands.h"

namespace pelage {

/// The form of the curves of a BasisCurves prim, and how points of ours follow from its vertices.
struct UsdCurveForm {
  enum class Basis { kBezier, kBSpline, kCatmullRom };
  enum class Wrap { kNonperiodic, kPinned, kPeriodic };
  bool cubic = true;
  Basis basis = Basis::kBezier;
  Wrap wrap = Wrap::kNonperiodic;

  /// Returns the form that these tokens of USD name; empty for unknown ones.
  static std::optional<UsdCurveForm> of(const std::string& type, const std::string& basis,
                                        const std::string& wrap);

  /// Returns the basis in which our points are the vertices themselves, for periodic curves with the first
  /// ones repeated at the end. Empty if curves are resampled for kCatmullRom.
  std::optional<CurveBasis> native() const;
  /// Numbers of segments, of varying values and of our points for a curve of `n` vertices. 0 segments: too
  /// few vertices. `resample`: even if native() has a value.
  uint32_t segments(uint32_t n) const;
  uint32_t varying(uint32_t n) const;
  uint32_t points(uint32_t n, bool resample) const;
};

/// A point of ours as a mean of vertices, and its place among varying values.
struct UsdCurvePoint {
  uint32_t vertex[4] = {0, 0, 0, 0};
  float weight[4] = {1, 0, 0, 0};
  uint32_t varying[2] = {0, 0};  ///< the point is between these two
  float along = 0;               ///< 0 at the first of them, 1 at the second
};

/// Returns point `i` of a curve of `n` vertices. Resampled curves get points at sixths of their segments, so
/// curves through them differ little from the original.
UsdCurvePoint usd_curve_point(const UsdCurveForm& form, uint32_t n, uint32_t i, bool resample);

}  // namespace pelage
