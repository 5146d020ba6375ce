// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "base/schema.h"
#include "base/vector.h"

namespace pelage {

/// Four flaps around a rectangle, hinged at its sides, which block light. Flaps are wide enough that no light
/// passes between two of them.
struct BarnDoors {
  float length = 0;  ///< from the hinge to the edge, in scene units; 0: none
  float left = 30, right = 30, top = 30, bottom = 30;  ///< degrees from straight ahead, outwards

  /// Returns whether a ray passes the doors. `place`: its start, relative to the centre of the rectangle.
  /// `direction`: x points to the right side, y to the top, z straight ahead.
  bool pass(const V2f& place, const V2f& half_size, const V3f& direction) const;
  /// Returns whether no light passes at all. `max_slope`: SpreadGrid::max_slope() of the rectangle.
  bool are_closed(const V2f& half_size, float max_slope) const;
  static const Schema<BarnDoors>& schema();
};

}  // namespace pelage
