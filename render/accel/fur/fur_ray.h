// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <cstdint>

#include "render/accel/fur/fur_hit.h"
#include "render/accel/fur/fur_tree.h"

namespace pelage {

/// A ray in the form used by the kernels, in grid units.
///
/// Ray space: let d be the ray's direction, k the axis of its largest component, i and j the other two axes,
/// and P a point relative to the ray's origin. X = d_k P_i - d_i P_k and Y = d_k P_j - d_j P_k are zero on
/// the whole line of the ray, even if rounding has changed the length of d [Woop13]. x and y are X and Y,
/// orthonormalised. z is the distance along the ray.
///
/// The end points of segments that a ray may hit are transformed in double precision, so that a large
/// distance from the ray's origin does not reduce accuracy. Single precision only decides which segments are
/// candidates, with a margin of `point_error_bound`.
struct FurRay {
  // Slab test [Kay86], by axis of the tree's frame; the fourth lane is unused.
  alignas(16) float inverse[4];
  alignas(16) float near_origin[4];  ///< shifted so that boxes are slightly enlarged
  alignas(16) float far_origin[4];
  uint32_t near_side[3];  ///< 1 where the direction is negative: the ray enters through high sides

  uint32_t axis[3];  ///< i, j, k
  float along_k, along_i, along_j;
  double origin_x, origin_y;        ///< X and Y of the ray's origin
  float scale_x, scale_y, shear_y;  ///< x = scale_x X, y = scale_y Y - shear_y X
  float depth[3];                   ///< z = depth . P - origin_depth
  double origin_depth;
  float point_error_bound;  ///< max error of x and y when computed in float from points of the tree

  float near, far;
  V3f origin, direction;
  int key = 0;         ///< the ray's time is between this motion key and the next
  float fraction = 0;  ///< position of the ray's time between the two keys, in [0, 1]
  FurStart start;

  /// Prepares a ray for a tree. Returns false for rays that hit nothing: rays that are not finite, rays whose
  /// origin is beyond FurGrid::kReach, and rays whose direction does not have a length between 1/2 and 2.
  bool prepare(const FurTreeView& tree, const Ray& ray, const FurStart& from);

  /// Parts of prepare(). Whether all numbers of a ray are finite, except the far end.
  static bool is_finite(const Ray& ray);
  /// Converts a point to grid units. Returns whether no coordinate is beyond FurGrid::kReach.
  static bool to_grid(const FurTreeView& tree, const V3f& point, double (&grid)[3]);
  /// Returns the axis of the largest component of a direction.
  static uint32_t main_axis(const V3f& direction);
  /// Returns `point_error_bound` of a ray with this largest absolute coordinate of its origin, in the frame
  /// of the tree.
  static float point_error(const FurTreeView& tree, float origin_reach);
  /// Returns the largest absolute coordinate of an origin in the frame of the tree. `origin`: in grid units.
  static float reach_in_frame(const FurTreeView& tree, const V3f& origin);

 private:
  friend class FurRays;
  void begin(const FurTreeView& tree, const Ray& ray, const FurStart& from);
  void transform_to(const FurFrame& frame);

  bool is_transformed_ = false;  // whether the ray has been transformed to frame_
  FurFrame frame_;
  V3f slab_origin_;
  float slab_reach_ = 0;  // largest absolute coordinate of slab_origin_
};

/// Prepares one ray for many trees in turn. The transformation to grid units is computed again only when the
/// grid changes. All chunks of a coat have the same grid.
class FurRays {
 public:
  /// Like FurRay::prepare(), but returns the prepared ray, or null instead of false. All calls must pass the
  /// same ray, except that its far end may decrease. The result is valid until the next call.
  const FurRay* prepare(const FurTreeView& tree, const Ray& ray, const FurStart& from) {
    if (!known_ || step_ != tree.step || anchor_ != tree.anchor || motion_keys_ != tree.motion_keys) {
      known_ = true;
      step_ = tree.step;
      anchor_ = tree.anchor;
      motion_keys_ = tree.motion_keys;
      finite_ = ray_.prepare(tree, ray, from);
    } else if (finite_) {
      ray_.begin(tree, ray, from);
    }
    return finite_ ? &ray_ : nullptr;
  }

 private:
  FurRay ray_;
  V3f anchor_{0};
  float step_ = 0;
  int motion_keys_ = 0;
  bool known_ = false, finite_ = false;
};

/// Like FurTree::closest() and FurTree::occluded(), for a ray that was prepared for this view. The view must
/// have nodes.
FurHit closest_fur(const FurTreeView& tree, const FurRay& ray, FurFilter* filter);
/// A block that holds a segment.
struct FurSegmentPlace {
  const std::byte* block = nullptr;
  bool wide = false;
  uint32_t number = FurHit::kNone;
};
/// Returns the first hit with one segment. closest_fur() returns the same hit if the ray hits no other
/// segment before.
FurHit closest_fur_at(const FurTreeView& tree, const FurRay& ray, const FurSegmentPlace& at,
                      FurFilter* filter);
bool fur_occludes(const FurTreeView& tree, const FurRay& ray, FurFilter* filter);

}  // namespace pelage
