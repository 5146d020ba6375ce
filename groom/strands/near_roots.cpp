// SPDX-License-Identifier: Apache-2.0
#include "groom/strands/near_roots.h"

#include <algorithm>

#include <Imath/ImathBox.h>

namespace pelage {

void NearRoots::collect(const RootRows& roots, size_t count) {
  constexpr size_t kMinStrands = 8;  // strands that are worth the search
  constexpr int kMaxWanted = 16;
  count_ = 0;
  if (count < kMinStrands || wanted_ > kMaxWanted) return;
  Box3f box;
  for (size_t s = 0; s < count; ++s) box.extendBy(vector_at(roots.position, s));
  centre_ = box.center();
  std::array<RootGrid::Neighbour, kMaxWanted> near;
  const V3f normal = vector_at(roots.normal, 0);
  if (grid_.nearest(centre_, normal, wanted_, near.data()) < wanted_) return;
  // Nearly always enough for a strand at a corner of the box.
  constexpr float kMore = 1.3f;
  distance_ = kMore * near[static_cast<size_t>(wanted_) - 1].distance + 0.5f * box.size().length();
  distance_ = std::min(distance_, 0.99f * grid_.radius());
  size_t found = 0;
  grid_.for_each_within(centre_, distance_, [&](uint32_t i) {
    if (found < kMaxPoints) {
      index_[found] = i;
      for (int axis = 0; axis < 3; ++axis) {
        position_[static_cast<size_t>(axis)][found] = grid_.position(i)[axis];
        normal_[static_cast<size_t>(axis)][found] = grid_.normal(i)[axis];
      }
    }
    ++found;
  });
  if (found > kMaxPoints) return;
  count_ = found;
  for (; found % 4 != 0; ++found) {
    for (size_t axis = 0; axis < 3; ++axis) position_[axis][found] = normal_[axis][found] = 0;  // no side
  }
}

}  // namespace pelage
