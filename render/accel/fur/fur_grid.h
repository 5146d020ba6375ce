// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <algorithm>
#include <cmath>

#include "base/vector.h"
#include "geom/strand_scale.h"

namespace pelage {

/// The grid to which the curves of one groom are snapped. A strand is snapped once, when it is grown. Its
/// step is a power of two, so that conversion to grid units and back is exact. The step depends only on the
/// groom's parameters, the origin only on the position of the character. So a strand decodes to the same
/// floats in the tree of any chunk.
///
/// In grid units, coordinates are integers. Floats beyond 2^24 are integers already, so large coordinates
/// need no special case. Radii have the form k^2 / 256 with an integer k, so their steps are finer at the
/// tip: the error is at most 0.7 % at the root, and 2 % for a radius of a tenth of the root's.
class FurGrid {
 public:
  /// `root_width`: width of the groom's strands at the root, in scene units. The step is the power of two for
  /// which this width has 192 to 384 steps; a width that is not a positive number is replaced by 2^-12.
  /// `anchor`: any finite point near the strands of the groom, the same for all strands.
  explicit FurGrid(float root_width, const V3f& anchor = V3f(0));
  /// The grid of a coat.
  explicit FurGrid(const StrandScale& scale) : FurGrid(scale.width, scale.anchor) {}

  float step() const { return step_; }
  const V3f& anchor() const { return anchor_; }

  /// The coordinate along an axis in grid units: rounded to the nearest step, ties to even.
  float snap(float scene, int axis) const {
    // The difference of two floats is exact in double, unless their exponents are too far apart.
    return static_cast<float>(whole((static_cast<double>(scene) - anchor_[axis]) * inverse_));
  }
  /// A coordinate difference along any axis, snapped.
  float snap_difference(float scene) const {
    return static_cast<float>(whole(static_cast<double>(scene) * inverse_));
  }
  /// Radii below 0 count as 0.
  float snap_radius(float scene) const {
    const double root = whole(kRootsPerUnit * std::sqrt(std::max(scene * inverse_, 0.0f)));
    return static_cast<float>(root * root) * (1 / (kRootsPerUnit * kRootsPerUnit));
  }

  /// How far a ribbon of at most this radius may extend beyond its original extent after snapping, in scene
  /// units.
  float margin(float radius) const;

  /// Nothing beyond this many steps is rendered: products of five coordinates must stay finite.
  static constexpr float kReach = 0x1p56f;

 private:
  static constexpr float kRootsPerUnit = 16;  // steps per unit in the square root of a radius

  /// Like std::nearbyint(), without a function call: beyond 2^51 every number is an integer.
  static double whole(double x) {
    constexpr double kAllWhole = 0x1.8p52;
    return std::abs(x) < 0x1p51 ? (x + kAllWhole) - kAllWhole : x;
  }

  float step_, inverse_;
  V3f anchor_;
};

}  // namespace pelage
