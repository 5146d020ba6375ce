// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <optional>

#include "geom/strands.h"

namespace pelage {

/// The form of curves in a file: their basis and how they end. Also, how the points of strands follow from
/// the vertices of such curves.
struct CurveForm {
  enum class Basis { kBezier, kBSpline, kCatmullRom };
  enum class Wrap { kNonperiodic, kPinned, kPeriodic };
  bool cubic = true;
  Basis basis = Basis::kBezier;
  Wrap wrap = Wrap::kNonperiodic;

  /// Returns the basis in which the vertices of a curve are the points of a strand; a periodic curve repeats
  /// its first vertices at the end. Returns nothing for curves that are resampled to kCatmullRom.
  std::optional<CurveBasis> native() const;
  /// Return the numbers of segments, of varying values and of points of the strand for a curve of `n`
  /// vertices. A curve with too few vertices has 0 segments. `resample`: resample the curve even if native()
  /// has a value.
  uint32_t segments(uint32_t n) const;
  uint32_t varying(uint32_t n) const;
  uint32_t points(uint32_t n, bool resample) const;
};

/// A point of a strand as a weighted sum of vertices, and its place among varying values.
struct CurvePoint {
  uint32_t vertex[4] = {0, 0, 0, 0};
  float weight[4] = {1, 0, 0, 0};
  uint32_t varying[2] = {0, 0};  ///< the point is between these two
  float along = 0;               ///< 0 at the first of them, 1 at the second
};

/// Returns point `i` of a curve of `n` vertices. Resampled curves get points at sixths of their segments, so
/// curves through them differ little from the original.
CurvePoint curve_point(const CurveForm& form, uint32_t n, uint32_t i, bool resample);

}  // namespace pelage
