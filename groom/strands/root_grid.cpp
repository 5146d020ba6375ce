// SPDX-License-Identifier: Apache-2.0
#include "groom/strands/root_grid.h"

#include <algorithm>
#include <bit>

#include "base/check.h"
#include "base/hash.h"

namespace pelage {

RootGrid::RootGrid(std::vector<V3f> positions, std::vector<V3f> normals, float radius)
    : radius_(radius),
      inverse_cell_(1.0f / radius),
      cell_(1 / static_cast<double>(inverse_cell_)),
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

size_t RootGrid::bucket(int64_t x, int64_t y, int64_t z) const {
  return mix64(static_cast<uint64_t>(x) * 0x9e3779b97f4a7c15ull ^
               static_cast<uint64_t>(y) * 0xc2b2ae3d27d4eb4full ^
               static_cast<uint64_t>(z) * 0x165667b19e3779f9ull) &
         (first_.size() - 2);
}

bool RootGrid::nearest(const V3f& position, const V3f& normal, Neighbour& result) const {
  return nearest_if(position, normal, result, [](uint32_t) { return true; });
}

int RootGrid::nearest(const V3f& position, const V3f& normal, int wanted, Neighbour* result) const {
  return nearest_if(position, normal, wanted, result, [](uint32_t) { return true; });
}

size_t RootGrid::bytes() const {
  return (positions_.capacity() + normals_.capacity()) * sizeof(V3f) +
         (first_.capacity() + items_.capacity()) * sizeof(uint32_t);
}

}  // namespace pelage
