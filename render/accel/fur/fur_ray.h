// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <cstdint>

#include "render/accel/fur/fur_hit.h"
#include "render/accel/fur/fur_tree.h"

namespace pelage {

/// A ray as the kernels want it, in grid units.
///
/// Ray space: with k the axis that the direction is longest along, X = d_k P_i - d_i P_k and Y = d_k P_j -
/// d_j P_k vanish on the whole line through the origin, whatever their rounding does to lengths [Woop13]; x
/// and y are X and Y made orthonormal, z is the distance along the ray. Of a segment that a ray may meet the
/// end points are brought there in double precision, so that neither their distance nor the ray's costs any
/// accuracy; floats decide only which segments come near, with `point_error_bound` to spare.
struct FurRay {
  // Slab test [Kay86], by axis of the tree's frame; the fourth lane is unused.
  alignas(16) float inverse[4];
  alignas(16) float near_origin[4];  ///< moved so that boxes are a little larger
  alignas(16) float far_origin[4];
  uint32_t near_side[3];  ///< 1 where the ray runs backward: it enters through high sides

  uint32_t axis[3];  ///< i, j, k
  float along_k, along_i, along_j;
  double origin_x, origin_y;        ///< of X and Y
  float scale_x, scale_y, shear_y;  ///< x = scale_x X, y = scale_y Y - shear_y X
  float depth[3];                   ///< z = depth . P - origin_depth
  double origin_depth;
  float point_error_bound;  ///< by how much x and y may be off where floats make them from points of the tree

  float near, far;
  V3f origin, direction;
  int key = 0;  ///< motion: between this key and the next
  float fraction = 0;
  FurStart start;

  /// False for rays that meet nothing because they are not finite.
  bool prepare(const FurTreeView& tree, const Ray& ray, const FurStart& from);

 private:
  friend class FurRays;
  void begin(const FurTreeView& tree, const Ray& ray, const FurStart& from);
  void transform_to(const FurFrame& frame);

  bool is_transformed_ = false;  // in frame_
  FurFrame frame_;
  V3f slab_origin_;
  float slab_reach_ = 0;  // its largest coordinate
};

/// One ray on its way through many trees. What it looks like in grid units is found once as long as their
/// grids are the same, as those of the chunks of a coat are.
class FurRays {
 public:
  /// As FurRay::prepare(); null where that is false. All calls are of one ray, whose far end may come nearer.
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

/// The queries of FurTree for a ray that was prepared for the view, which has nodes.
FurHit closest_fur(const FurTreeView& tree, const FurRay& ray, FurFilter* filter, FurTests* tests = nullptr);
bool fur_occludes(const FurTreeView& tree, const FurRay& ray, FurFilter* filter, FurTests* tests = nullptr);

}  // namespace pelage
