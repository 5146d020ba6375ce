// SPDX-License-Identifier: Apache-2.0
#include "procedurals/bounds/chunk_bounds.h"

#include <utility>

namespace pelage {
namespace {

double surface(const Box3f& box) {
  if (box.isEmpty()) return 0;
  const V3f d = box.size();
  return 2 * (double(d.x) * d.y + double(d.y) * d.z + double(d.z) * d.x);
}

}  // namespace

ChunkBounds ChunkBounds::in_one_part() && {
  ChunkBounds one;
  one.keys = keys;
  one.boxes.resize(boxes.empty() ? 0 : static_cast<size_t>(keys));
  for (size_t i = 0; i < boxes.size(); ++i) one.boxes[i % static_cast<size_t>(keys)].extendBy(boxes[i]);
  one.cell_bounds = std::move(cell_bounds);
  return one;
}

BoundsArea area_of(const ChunkBounds& chunk) {
  BoundsArea sum;
  for (int key = 0; key < chunk.keys; ++key) {
    Box3f whole;
    for (size_t part = 0; part < chunk.part_count(); ++part) {
      whole.extendBy(chunk.box(part, key));
      sum.parts += surface(chunk.box(part, key)) / chunk.keys;
    }
    sum.chunks += surface(whole) / chunk.keys;
  }
  return sum;
}

}  // namespace pelage
