// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <cstdint>

#include "render/accel/fur/fur_hit.h"
#include "render/accel/fur/fur_tree.h"

namespace pelage {

/// A ray in the form used by the kernels, in grid units.
///
/// Ray space: with k the axis of the direction's largest component, X = d_k P_i - d_i P_k and Y = d_k P_j -
/// d_j P_k vanish on the whole line through the origin, whatever rounding does to lengths [Woop13]; x and y
/// are X and Y, orthonormalised; z is the distance along the ray. End points of segments that a ray may hit
/// are transformed in double precision, so that distance does not reduce accuracy; floats only decide which
/// segments are candidates, with a margin of `point_error_bound`.
struct FurRay {
  // Slab test [Kay86], by axis of the tree's frame; the fourth lane is unused.
  alignas(16) float inverse[4];
  alignas(16) float near_origin[4];  ///< shifted so that boxes are slightly enlarged
  alignas(16) float far_origin[4];
  uint32_t near_side[3];  ///< 1 where the direction is negative: the ray enters through high sides

  uint32_t axis[3];  ///< i, j, k
  float along_k, along_i, along_j;
  double origin_x, origin_y;        ///< of X and Y
  float scale_x, scale_y, shear_y;  ///< x = scale_x X, y = scale_y Y - shear_y X
  float depth[3];                   ///< z = depth . P - origin_depth
  double origin_depth;
  float point_error_bound;  ///< max error of x and y when computed in float from points of the tree

  float near, far;
  V3f origin, direction;
  int key = 0;  ///< motion: between this key and the next
  float fraction = 0;
  FurStart start;

  /// False for rays that hit nothing because they are not finite.
  bool prepare(const FurTreeView& tree, const Ray& ray, const FurStart& from);

 private:
  friend class FurRays;
  void begin(const FurTreeView& tree, const Ray& ray, const FurStart& from);
  void transform_to(const FurFrame& frame);

  bool is_transformed_ = false;  // whether the ray has been transformed to frame_
  FurFrame frame_;
  V3f slab_origin_;
  float slab_reach_ = 0;  // its largest coordinate
};

/// One ray traced through many trees. Its transformation to grid units is reused while the grids are equal,
/// as in all chunks of a coat.
class FurRays {
 public:
  /// As FurRay::prepare(); null where that is false. All calls must be for one ray, whose far end may
  /// decrease.
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

/// The queries of FurTree for a ray prepared for this view, which must have nodes.
FurHit closest_fur(const FurTreeView& tree, const FurRay& ray, FurFilter* filter, FurTests* tests = nullptr);
/// A block that holds a segment.
struct FurSegmentPlace {
  const std::byte* block = nullptr;
  bool wide = false;
  uint32_t number = FurHit::kNone;
};
/// The first hit with one segment: the same as that of closest_fur() where no other segment is hit before.
FurHit closest_fur_at(const FurTreeView& tree, const FurRay& ray, const FurSegmentPlace& at,
                      FurFilter* filter);
bool fur_occludes(const FurTreeView& tree, const FurRay& ray, FurFilter* filter, FurTests* tests = nullptr);

}  // namespace pelage
