// SPDX-License-Identifier: Apache-2.0
#include "render/accel/segment_cell_hits.h"

#include <algorithm>
#include <array>

namespace pelage {

SegmentCellHits intersect_segment_cell_bounds(const SegmentCellBounds& boxes, const RaySlabs& ray, float far,
                                              bool all, int64_t& tests, float margin) {
  SegmentCellHits hits;
  if (boxes.count() == 0) return hits;
  const GridSlabs slabs(ray, boxes.grid(), margin);
  struct Entry {
    float distance;
    uint32_t level, group;
  };
  // Three siblings are pending on each level below the highest; 2^32 boxes have 16 levels.
  std::array<Entry, 64> stack;
  size_t waiting = 0;
  stack[waiting++] = {0, static_cast<uint32_t>(boxes.levels() - 1), 0};
  while (waiting > 0) {
    const Entry top = stack[--waiting];
    if (top.distance > far) continue;
    const auto groups = boxes.level(top.level);
    Four enter, leave;
    const auto entered = slabs.intersect(groups[top.group], far, enter, leave);
    tests += 4;
    const size_t first = waiting;
    for (uint32_t lane = 0; lane < 4; ++lane) {
      if (!entered[lane]) continue;
      if (top.level == 0) {
        hits.entry = std::min(hits.entry, enter[lane]);
        ++hits.boxes;
        if (!all) far = std::min(far, hits.entry);
        continue;
      }
      const uint32_t group = 4 * top.group + lane;
      if (group >= boxes.level(top.level - 1).size()) continue;
      size_t at = waiting++;
      for (; at > first && stack[at - 1].distance < enter[lane]; --at) stack[at] = stack[at - 1];
      stack[at] = {enter[lane], top.level - 1, group};
    }
  }
  return hits;
}

}  // namespace pelage
