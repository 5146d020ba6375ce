// SPDX-License-Identifier: Apache-2.0
#include "render/accel/fur/fur_ray_batch.h"

namespace pelage {

FurRayBatch::FurRayBatch(const FurTreeView& tree, std::span<const Ray* const> rays) : count(rays.size()) {
  const float grid = 1 / tree.step;
  axis[2] = FurRay::main_axis(rays[0]->direction);
  axis[0] = (axis[2] + 1) % 3;
  axis[1] = (axis[2] + 2) % 3;
  // Rays through a pinhole have the same origin.
  V3f last(0);
  double at[3];
  float error = 0;
  bool within = false;
  for (size_t i = 0; i < count; ++i) {
    const Ray& ray = *rays[i];
    if (i == 0 || ray.origin != last) {
      last = ray.origin;
      within = FurRay::to_grid(tree, last, at);
      const V3f rounded(static_cast<float>(at[0]), static_cast<float>(at[1]), static_cast<float>(at[2]));
      error = FurRay::point_error(tree, FurRay::reach_in_frame(tree, rounded));
    }
    for (size_t a = 0; a < 3; ++a) {
      direction[a][i] = ray.direction[static_cast<int>(a)];
      origin[a][i] = at[a];
    }
    point_error_bound[i] = error;
    near[i] = ray.near * grid;
    far[i] = ray.far * grid;
    if (!within || !FurRay::is_finite(ray) || FurRay::main_axis(ray.direction) != axis[2]) others |= 1u << i;
  }
}

}  // namespace pelage
