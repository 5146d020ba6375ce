// SPDX-License-Identifier: Apache-2.0
#include "render/accel/fur/fur_ray.h"

#include <algorithm>
#include <cmath>

namespace pelage {
namespace {

// Max rounding error of a box, relative to the largest input: 32 units in the last place, of which slabs take
// less than half. Points in ray space computed in float have an error below 35 units, including rotated
// frames (where numbers may be smaller by the square root of 3).
constexpr float kErrorBound = 0x1p-19f;
constexpr float kSmallest = 1e-18f;  // min direction component: its inverse is usable

float largest(const V3f& p) { return std::max({std::abs(p.x), std::abs(p.y), std::abs(p.z)}); }

}  // namespace

bool FurRay::is_finite(const Ray& ray) {
  const float sum = ray.origin.x + ray.origin.y + ray.origin.z + ray.direction.x + ray.direction.y +
                    ray.direction.z + ray.near + ray.time;
  return std::isfinite(sum) && !std::isnan(ray.far);
}

bool FurRay::to_grid(const FurTreeView& tree, const V3f& point, double (&grid)[3]) {
  const float inverse = 1 / tree.step;
  V3f rounded;
  for (int i = 0; i < 3; ++i) {
    grid[i] = (double(point[i]) - tree.anchor[i]) * inverse;
    rounded[i] = static_cast<float>(grid[i]);
  }
  return largest(rounded) <= FurGrid::kReach;
}

uint32_t FurRay::main_axis(const V3f& direction) {
  const V3f size_of(std::abs(direction.x), std::abs(direction.y), std::abs(direction.z));
  return size_of.x > size_of.y ? (size_of.x > size_of.z ? 0 : 2) : (size_of.y > size_of.z ? 1 : 2);
}

float FurRay::point_error(const FurTreeView& tree, float origin_reach) {
  return 2 * kErrorBound * (origin_reach + tree.reach);
}

float FurRay::reach_in_frame(const FurTreeView& tree, const V3f& origin) {
  return largest(tree.frame.turned ? tree.frame(origin) : origin);
}

bool FurRay::prepare(const FurTreeView& tree, const Ray& ray, const FurStart& from) {
  double grid_origin[3];
  if (!is_finite(ray) || !to_grid(tree, ray.origin, grid_origin)) return false;
  const V3f& d = ray.direction;
  for (int i = 0; i < 3; ++i) origin[i] = static_cast<float>(grid_origin[i]);
  direction = d;
  inverse[3] = near_origin[3] = far_origin[3] = 0;
  is_transformed_ = false;
  begin(tree, ray, from);

  const uint32_t k = main_axis(d);
  const uint32_t i = (k + 1) % 3, j = (k + 2) % 3;
  axis[0] = i, axis[1] = j, axis[2] = k;
  along_i = d[static_cast<int>(i)];
  along_j = d[static_cast<int>(j)];
  along_k = d[static_cast<int>(k)];
  const double di = along_i, dj = along_j, dk = along_k;
  const double length2 = di * di + dj * dj + dk * dk;
  if (!(length2 > 0.25 && length2 < 4)) return false;
  origin_x = dk * grid_origin[i] - di * grid_origin[k];
  origin_y = dk * grid_origin[j] - dj * grid_origin[k];
  // X and Y are products with e1 = dk i - di k and e2 = dk j - dj k; e2 - (e1 . e2 / e1 . e1) e1 has the
  // length |dk| |d| / |e1|. The sign makes x, y and the ray a right-handed frame.
  const double first2 = dk * dk + di * di;
  const double first = std::sqrt(first2);
  const double second = first / (dk * std::sqrt(length2));
  scale_x = static_cast<float>(1 / first);
  scale_y = static_cast<float>(second);
  shear_y = static_cast<float>(second * (di * dj / first2));
  const double unit = 1 / length2;
  origin_depth = 0;
  for (int a = 0; a < 3; ++a) {
    depth[a] = static_cast<float>(d[a] * unit);
    origin_depth += static_cast<double>(depth[a]) * grid_origin[a];
  }

  key = 0;
  fraction = 0;
  if (tree.motion_keys > 1) {
    const float scaled = std::clamp(ray.time, 0.0f, 1.0f) * static_cast<float>(tree.motion_keys - 1);
    key = std::min(static_cast<int>(scaled), tree.motion_keys - 2);
    fraction = scaled - static_cast<float>(key);
  }
  return true;
}

void FurRay::begin(const FurTreeView& tree, const Ray& ray, const FurStart& from) {
  const float grid = 1 / tree.step;
  near = ray.near * grid;
  far = ray.far * grid;
  start = from;
  if (!is_transformed_ || !(frame_ == tree.frame)) transform_to(tree.frame);
  // Rotation adds a few units of rounding to boxes and rays.
  const float reach = slab_reach_ + tree.reach;
  const float error_bound = (tree.frame.turned ? 2 * kErrorBound : kErrorBound) * reach;
  point_error_bound = point_error(tree, slab_reach_);
  for (int i = 0; i < 3; ++i) {
    const float outward = near_side[i] == 1 ? error_bound : -error_bound;
    near_origin[i] = slab_origin_[i] - outward;
    far_origin[i] = slab_origin_[i] + outward;
  }
}

void FurRay::transform_to(const FurFrame& frame) {
  is_transformed_ = true;
  frame_ = frame;
  slab_origin_ = frame.turned ? frame(origin) : origin;
  slab_reach_ = largest(slab_origin_);
  const V3f d = frame.turned ? frame(direction) : direction;
  for (int i = 0; i < 3; ++i) {
    const float along = std::abs(d[i]) < kSmallest ? std::copysign(kSmallest, d[i]) : d[i];
    inverse[i] = 1 / along;
    near_side[i] = along < 0 ? 1 : 0;
  }
}

}  // namespace pelage
