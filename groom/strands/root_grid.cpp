// SPDX-License-Identifier: Apache-2.0
#include "groom/strands/root_grid.h"

#include <algorithm>
#include <bit>
#include <cmath>

#include "base/check.h"
#include "base/hash.h"

namespace pelage {

RootGrid::RootGrid(std::vector<V3f> positions, std::vector<V3f> normals, float radius)
    : radius_(radius),
      inverse_cell_(1.0f / radius),
      positions_(std::move(positions)),
      normals_(std::move(normals)) {
  PELAGE_CHECK(positions_.size() == normals_.size() && radius > 0);
  first_.assign(std::bit_ceil(2 * positions_.size() + 1) + 1, 0);
  const auto bucket_of = [this](const V3f& p) { return bucket(cell(p.x), cell(p.y), cell(p.z)); };
  for (const V3f& p : positions_) ++first_[bucket_of(p)];
  // End of each bucket; places are inserted from the end, which leaves its start.
  for (size_t b = 1; b < first_.size(); ++b) first_[b] += first_[b - 1];
  items_.resize(positions_.size());
  for (size_t i = positions_.size(); i-- > 0;)
    items_[--first_[bucket_of(positions_[i])]] = static_cast<uint32_t>(i);
}

int64_t RootGrid::cell(float coordinate) const {
  return static_cast<int64_t>(std::floor(static_cast<double>(coordinate) * inverse_cell_));
}

size_t RootGrid::bucket(int64_t x, int64_t y, int64_t z) const {
  return mix64(static_cast<uint64_t>(x) * 0x9e3779b97f4a7c15ull ^
               static_cast<uint64_t>(y) * 0xc2b2ae3d27d4eb4full ^
               static_cast<uint64_t>(z) * 0x165667b19e3779f9ull) &
         (first_.size() - 2);
}

bool RootGrid::nearest(const V3f& position, const V3f& normal, Neighbour& result) const {
  float best = 0;
  bool found = false;
  for_each_near(position, normal, [&](uint32_t i, float distance2) {
    if (found && (distance2 > best || (distance2 == best && i > result.index))) return;
    found = true;
    best = distance2;
    result.index = i;
  });
  result.distance = std::sqrt(best);
  return found;
}

int RootGrid::nearest(const V3f& position, const V3f& normal, int wanted, Neighbour* result) const {
  int count = 0;
  const auto before = [](const Neighbour& a, const Neighbour& b) {
    return a.distance != b.distance ? a.distance < b.distance : a.index < b.index;
  };
  for_each_near(position, normal, [&](uint32_t i, float distance2) {
    Neighbour candidate{i, std::sqrt(distance2)};
    if (count == wanted && !before(candidate, result[count - 1])) return;
    if (count < wanted) ++count;
    int at = count - 1;
    for (; at > 0 && before(candidate, result[at - 1]); --at) result[at] = result[at - 1];
    result[at] = candidate;
  });
  return count;
}

size_t RootGrid::bytes() const {
  return (positions_.capacity() + normals_.capacity()) * sizeof(V3f) +
         (first_.capacity() + items_.capacity()) * sizeof(uint32_t);
}

}  // namespace pelage
