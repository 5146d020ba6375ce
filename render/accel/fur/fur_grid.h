// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <algorithm>
#include <cmath>

#include "base/vector.h"
#include "geom/strand_scale.h"

namespace pelage {

/// The grid that the curves of one groom are snapped to, once, when a strand is grown. Its step is a power of
/// two, so that going to grid units and back is exact; it depends on the groom's parameters alone, and where
/// it stands on the place of the character, so that every tree over a strand, whatever its chunk, decodes the
/// same floats.
///
/// In grid units a coordinate is a whole number. Floats beyond 2^24 are whole numbers already, so that
/// nothing special happens far from the origin. Radii are squares of whole numbers over 256: finer at a tip
/// (2 % of a radius that is a tenth of the root's) and never off by more than 0.7 % at the root.
class FurGrid {
 public:
  /// `root_width`: of the groom's strands, in scene units. The step is the power of two by which this width
  /// has 192 to 384 steps; a width that is no positive number counts as 2^-12.
  /// `anchor`: any finite point near all strands of the groom, the same for all of them.
  explicit FurGrid(float root_width, const V3f& anchor = V3f(0));
  /// That of a coat.
  explicit FurGrid(const StrandScale& scale) : FurGrid(scale.width, scale.anchor) {}

  float step() const { return step_; }
  const V3f& anchor() const { return anchor_; }

  /// The coordinate along an axis in grid units: the nearest whole number of steps, halves to even ones.
  float snap(float scene, int axis) const {
    // Two floats differ by a double without rounding, unless one of them is out of the other's reach.
    return static_cast<float>(whole((static_cast<double>(scene) - anchor_[axis]) * inverse_));
  }
  /// A difference of coordinates along any axis.
  float snap_difference(float scene) const {
    return static_cast<float>(whole(static_cast<double>(scene) * inverse_));
  }
  /// Radii below 0 count as none.
  float snap_radius(float scene) const {
    const double root = whole(kRootsPerUnit * std::sqrt(std::max(scene * inverse_, 0.0f)));
    return static_cast<float>(root * root) * (1 / (kRootsPerUnit * kRootsPerUnit));
  }

  /// How far a ribbon of at most this radius may reach, once it is snapped, beyond where it reached before:
  /// scene units.
  float margin(float radius) const;

  /// Beyond this many steps nothing is drawn: products of five coordinates must stay finite.
  static constexpr float kReach = 0x1p56f;

 private:
  static constexpr float kRootsPerUnit = 16;  // of radii: their square roots have this many steps

  /// As std::nearbyint(), without a call: beyond 2^51 every number is whole.
  static double whole(double x) {
    constexpr double kAllWhole = 0x1.8p52;
    return std::abs(x) < 0x1p51 ? (x + kAllWhole) - kAllWhole : x;
  }

  float step_, inverse_;
  V3f anchor_;
};

}  // namespace pelage
