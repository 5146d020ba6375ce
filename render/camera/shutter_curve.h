// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>
#include <vector>

#include "base/value_readers.h"
#include "base/vector.h"

namespace pelage {

/// The light that a shutter lets through while it is open, as a function of the shutter time: piecewise
/// linear, and constant before the first and after the last point. The default is 1 at all times. Immutable.
class ShutterCurve {
 public:
  ShutterCurve() = default;
  /// `points`: (shutter time, weight). Times must be in [0, 1] and must not decrease. Weights must not be
  /// negative, and their integral must not be 0.
  explicit ShutterCurve(std::vector<V2f> points);

  /// Returns the shutter time below which the fraction `u` of the light passes. For random numbers `u` in
  /// [0, 1), times are distributed exactly as the curve, so that all samples have the same weight.
  float time(float u) const;

 private:
  struct Segment {
    double begin, width, at_begin, slope;  // the weight is at_begin + slope * (time - begin)
    double before;                         // fraction of the light that passes before this segment
  };
  std::vector<Segment> segments_;  // empty: always 1
};

/// Reads `box`, `triangle`, `trapezoid` or a list of points [time, weight].
template <>
struct ValueReader<ShutterCurve> {
  static bool read(const Value&, const KeyOptions&, ShutterCurve& out, Problems&);
  static std::string type_name() { return "box, triangle, trapezoid or points"; }
  static std::string print(const ShutterCurve&) { return "box"; }
};

}  // namespace pelage
