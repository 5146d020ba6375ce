// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <algorithm>
#include <cmath>

#include "base/vector.h"
#include "geom/strand_scale.h"

namespace pelage {

/// The grid to which the curves of one groom are snapped. A strand is snapped once, when its chunk is grown.
/// The step of the grid is a power of two, so that multiplication and division by the step are exact. The
/// step depends only on the groom's parameters, and the grid's origin depends only on the position of the
/// character. So a strand decodes to the same floats in the tree of any chunk.
///
/// In grid units, coordinates are integers. Floats beyond 2^24 are integers already, so large coordinates
/// need no special case. Radii have the form k^2 / 256 with an integer k, so small radii have finer steps
/// than large ones. The rounding error of a radius is at most 0.7 % at the root, and at most 2 % where the
/// radius is a tenth of the radius at the root.
class FurGrid {
 public:
  /// `root_width`: width of the groom's strands at the root, in scene units. The step is the power of two for
  /// which this width has 192 to 384 steps. A width that is not positive or not finite is replaced by 2^-12;
  /// other widths are clamped to [2^-60, 2^60]. `anchor`: origin of the grid, which may be any finite point
  /// near the strands of the groom. It must be the same for all strands.
  explicit FurGrid(float root_width, const V3f& anchor = V3f(0));
  /// Makes the grid of a coat whose strands have this scale.
  explicit FurGrid(const StrandScale& scale) : FurGrid(scale.width, scale.anchor) {}

  float step() const { return step_; }
  const V3f& anchor() const { return anchor_; }

  /// Returns a scene coordinate along an axis in grid units, rounded to the nearest integer (ties to even).
  float snap(float scene, int axis) const {
    // The difference of two floats is exact in double, unless their exponents are too far apart.
    return static_cast<float>(whole((static_cast<double>(scene) - anchor_[axis]) * inverse_));
  }
  /// Returns a difference of scene coordinates along any axis in grid units, rounded likewise.
  float snap_difference(float scene) const {
    return static_cast<float>(whole(static_cast<double>(scene) * inverse_));
  }
  /// Returns a radius in grid units, rounded to the form k^2 / 256. A radius below 0 becomes 0.
  float snap_radius(float scene) const {
    const double root = whole(kRootsPerUnit * std::sqrt(std::max(scene * inverse_, 0.0f)));
    return static_cast<float>(root * root) * (1 / (kRootsPerUnit * kRootsPerUnit));
  }

  /// Returns the max distance by which a snapped ribbon may extend beyond the original ribbon, if no radius
  /// exceeds `radius`. Both are in scene units.
  float margin(float radius) const;

  /// Segments and ray origins with a coordinate beyond this many steps are not rendered. Up to this limit,
  /// sums of products of two coordinates are finite floats.
  static constexpr float kReach = 0x1p56f;

 private:
  static constexpr float kRootsPerUnit = 16;  // steps per unit in the square root of a radius

  /// Rounds like std::nearbyint(), without a function call. Returns numbers beyond 2^51 unchanged: the
  /// conversion to float, which follows, makes them integers.
  static double whole(double x) {
    constexpr double kAllWhole = 0x1.8p52;
    return std::abs(x) < 0x1p51 ? (x + kAllWhole) - kAllWhole : x;
  }

  float step_, inverse_;
  V3f anchor_;
};

}  // namespace pelage
