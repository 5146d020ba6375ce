// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <algorithm>
#include <array>
#include <cmath>

#include "geom/four_lanes.h"
#include "procedurals/bounds/segment_cell_bounds.h"
#include "render/accel/accel.h"

namespace pelage {

/// Four boxes, one per lane: for each axis, the low sides and then the high sides. Inverted boxes are never
/// intersected.
using FourBoxes = std::array<std::array<Four, 2>, 3>;

class GridSlabs;

/// A ray prepared for the slab test [Kay86].
///
/// The test is conservative: a box counts as intersected if rounding errors, on the scale of the scene and of
/// the ray's origin, leave the result uncertain. So no hit of an exact intersector inside a box is lost.
class RaySlabs {
 public:
  /// `reach`: largest absolute coordinate of all boxes that will be tested.
  RaySlabs(const Ray& ray, float reach) : near_(ray.near), time_(four(ray.time)) {
    const auto size = [](const V3f& v) { return std::max({std::abs(v.x), std::abs(v.y), std::abs(v.z)}); };
    const float error_bound = kErrorBound * (size(ray.origin) + reach);
    for (int i = 0; i < 3; ++i) {
      float d = ray.direction[i];
      if (std::abs(d) < kSmallest) d = std::copysign(kSmallest, d);
      Axis& axis = axes_[static_cast<size_t>(i)];
      const bool backward = d < 0;
      axis.near_side = backward ? 1 : 0;
      // Low sides are moved down by the error bound and high sides up, whichever the ray enters first.
      axis.near_origin = four(ray.origin[i] + (backward ? -error_bound : error_bound));
      axis.far_origin = four(ray.origin[i] + (backward ? error_bound : -error_bound));
      axis.inverse = four(1.0f / d);
    }
  }

  float near() const { return near_; }

  /// Tests four boxes against the ray between its near end and `far`. Returns -1 in the lanes of intersected
  /// boxes and 0 in the other lanes. Stores lower bounds of the entry distances in `enter`, and upper bounds
  /// of the exit distances in `leave`. `motion`: displacement of the boxes' sides from shutter open to
  /// shutter close; null without motion.
  auto intersect(const FourBoxes& boxes, const FourBoxes* motion, float far, Four& enter, Four& leave) const {
    enter = four(near_);
    leave = four(far);
    for (size_t i = 0; i < 3; ++i) {
      const Axis& axis = axes_[i];
      Four near_side = boxes[i][axis.near_side], far_side = boxes[i][1 - axis.near_side];
      if (motion) {
        near_side += time_ * (*motion)[i][axis.near_side];
        far_side += time_ * (*motion)[i][1 - axis.near_side];
      }
      enter = larger((near_side - axis.near_origin) * axis.inverse * four(1 - kErrorBound), enter);
      leave = smaller((far_side - axis.far_origin) * axis.inverse * four(1 + kErrorBound), leave);
    }
    return enter <= leave;
  }

 private:
  friend class GridSlabs;

  // Max rounding error of a box side or of a hit, relative to the largest input: 32 units in the last place.
  // Less than half of it is for the tests in this file, and less than half is for the hits of Embree or of
  // the fur tree (FurRay).
  static constexpr float kErrorBound = 0x1p-19f;
  // Min magnitude of a direction component, so that its inverse is finite.
  static constexpr float kSmallest = 1e-18f;

  struct Axis {
    Four near_origin, far_origin, inverse;
    size_t near_side = 0;
  };
  std::array<Axis, 3> axes_;
  float near_;
  Four time_;
};

/// A ray prepared for the slab test of cell bounds. Their sides are whole numbers of steps from a corner,
/// which may move (see SegmentCellBounds).
class GridSlabs {
 public:
  /// `margin`: distance by which boxes are enlarged on every side.
  GridSlabs(const RaySlabs& ray, const SegmentCellBounds::Grid& grid, float margin) : near_(ray.near_) {
    for (int i = 0; i < 3; ++i) {
      const auto axis = static_cast<size_t>(i);
      const RaySlabs::Axis& of = ray.axes_[axis];
      const Four corner = four(grid.corner[i]) + ray.time_ * four(grid.motion[i]), step = four(grid.step[i]);
      const Four outward = four(of.near_side == 1 ? margin : -margin);
      const Four near_inverse = of.inverse * four(1 - RaySlabs::kErrorBound);
      const Four far_inverse = of.inverse * four(1 + RaySlabs::kErrorBound);
      axes_[axis] = {(corner + outward - of.near_origin) * near_inverse, step * near_inverse,
                     (corner - outward - of.far_origin) * far_inverse, step * far_inverse, of.near_side};
    }
  }

  /// Tests four cell bounds as RaySlabs::intersect() tests boxes. The error bound of RaySlabs also covers the
  /// rounding of the corner, because the corner lies in the scene.
  auto intersect(const SegmentCellBounds::Group& boxes, float far, Four& enter, Four& leave) const {
    enter = four(near_);
    leave = four(far);
    for (size_t i = 0; i < 3; ++i) {
      const Axis& axis = axes_[i];
      enter = larger(number(boxes[i][axis.near_side]) * axis.near_step + axis.near_corner, enter);
      leave = smaller(number(boxes[i][1 - axis.near_side]) * axis.far_step + axis.far_corner, leave);
    }
    return enter <= leave;
  }

 private:
  static Four number(const std::array<uint8_t, 4>& sides) {
    return Four{static_cast<float>(sides[0]), static_cast<float>(sides[1]), static_cast<float>(sides[2]),
                static_cast<float>(sides[3])};
  }

  struct Axis {
    Four near_corner, near_step, far_corner, far_step;
    size_t near_side = 0;
  };
  std::array<Axis, 3> axes_;
  float near_;
};

}  // namespace pelage
