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
/// and y are X and Y made orthonormal, z is the distance along the ray. What the origin contributes is
/// subtracted as one number, taken in double precision, so that its distance costs no accuracy.
struct FurRay {
  // Slab test [Kay86], by axis; the fourth lane is unused.
  alignas(16) float inverse[4];
  alignas(16) float near_origin[4];  ///< moved so that boxes are a little larger
  alignas(16) float far_origin[4];
  uint32_t near_side[3];  ///< 1 where the ray runs backward: it enters through high sides

  uint32_t axis[3];  ///< i, j, k
  float along_k, along_i, along_j;
  float origin_x, origin_y;         ///< of X and Y
  float scale_x, scale_y, shear_y;  ///< x = scale_x X, y = scale_y Y - shear_y X
  float depth[3], origin_depth;     ///< z = depth . P - origin_depth

  float near, far;
  int key = 0;  ///< motion: between this key and the next
  float fraction = 0;
  FurStart start;

  /// False for rays that meet nothing because they are not finite.
  bool prepare(const FurTreeView& tree, const Ray& ray, const FurStart& from);
};

}  // namespace pelage
