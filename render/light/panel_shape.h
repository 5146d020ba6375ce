// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <limits>

#include "base/schema.h"
#include "base/vector.h"

namespace pelage {

/// A grid of thin black walls in front of a panel, as on softboxes: the farther a direction is from the
/// normal, the more of its light the walls take. As the spread of Cycles' area lights.
class SpreadGrid {
 public:
  /// No grid.
  SpreadGrid() = default;
  /// `degrees`: the whole angle beyond which no light passes, from 1; no grid from 180 on.
  explicit SpreadGrid(float degrees);

  /// Returns the fraction of light that passes at an angle to the normal, given by its cosine.
  float factor(float cosine) const;
  /// Returns the fraction of the power of a panel that passes.
  double passed() const;

 private:
  double half_angle_ = 0;
  float slope_ = 0;  // 1 / tan of the half angle
};

/// Four flaps around a rectangle, hinged at its sides, which block light. Flaps are wide enough that no light
/// passes between two of them.
struct BarnDoors {
  float length = 0;  ///< from the hinge to the edge, in scene units; 0: none
  float left = 30, right = 30, top = 30, bottom = 30;  ///< degrees from straight ahead, outwards

  /// Returns whether a ray leaves the doors that starts at `place`, relative to the centre, in a direction of
  /// which x points to the right side, y to the top, and z straight ahead.
  bool pass(const V2f& place, const V2f& half_size, const V3f& direction) const;
  static const Schema<BarnDoors>& schema();
};

}  // namespace pelage
