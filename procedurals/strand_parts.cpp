// SPDX-License-Identifier: Apache-2.0
#include "procedurals/strand_parts.h"

#include <algorithm>
#include <cmath>
#include <numeric>

#include "geom/curve_bounds.h"

namespace pelage {
namespace {

/// Orders middles[order[begin .. end-1]] and appends where each of `parts` parts ends.
void divide(std::span<const V3f> middles, std::vector<uint32_t>& order, size_t begin, size_t end,
            size_t parts, std::vector<uint32_t>& first) {
  if (parts == 1) {
    first.push_back(static_cast<uint32_t>(end));
    return;
  }
  Box3f box;
  for (size_t i = begin; i < end; ++i) box.extendBy(middles[order[i]]);
  const int axis = static_cast<int>(box.majorAxis());
  const size_t left = parts / 2;
  const size_t middle = begin + (end - begin) * left / parts;
  const auto at = [&](size_t i) { return order.begin() + static_cast<ptrdiff_t>(i); };
  std::nth_element(at(begin), at(middle), at(end), [&](uint32_t a, uint32_t b) {
    return middles[a][axis] != middles[b][axis] ? middles[a][axis] < middles[b][axis] : a < b;
  });
  divide(middles, order, begin, middle, left, first);
  divide(middles, order, middle, end, parts - left, first);
}

}  // namespace

StrandParts divide_into_parts(const Strands& strands, size_t most) {
  StrandParts parts;
  const size_t count = strands.strand_count();
  if (count == 0) return parts;
  std::vector<V3f> middles(count);
  for (size_t i = 0; i < count; ++i) {
    middles[i] = strands.point(strands.first_point(i) + strands.strand_points(i) / 2);
  }
  parts.order.resize(count);
  std::iota(parts.order.begin(), parts.order.end(), 0u);
  parts.first.push_back(0);
  divide(middles, parts.order, 0, count, (count + most - 1) / most, parts.first);
  return parts;
}

void interpolate_boxes(std::span<const Box3f> boxes, Box3f& open, Box3f& close) {
  open = boxes.front();
  close = boxes.back();
  if (open.isEmpty()) return;
  for (int axis = 0; axis < 3; ++axis) {
    double below = 0, above = 0;
    float largest = 0;
    for (size_t k = 0; k < boxes.size(); ++k) {
      const double t = boxes.size() < 2 ? 0 : static_cast<double>(k) / static_cast<double>(boxes.size() - 1);
      const auto between = [&](float a, float b) { return (1 - t) * a + t * b; };
      below = std::max(below, between(boxes.front().min[axis], boxes.back().min[axis]) - boxes[k].min[axis]);
      above = std::max(above, boxes[k].max[axis] - between(boxes.front().max[axis], boxes.back().max[axis]));
      largest = std::max({largest, std::abs(boxes[k].min[axis]), std::abs(boxes[k].max[axis])});
    }
    // Whoever interpolates in float rounds three times.
    const float rounding = 0x1p-21f * largest;
    for (Box3f* box : {&open, &close}) {
      box->min[axis] -= static_cast<float>(below) + rounding;
      box->max[axis] += static_cast<float>(above) + rounding;
    }
  }
}

ChunkBounds exact_part_bounds(const Strands& strands, const StrandParts& parts, int keys) {
  ChunkBounds bounds;
  bounds.keys = keys;
  const auto motion_keys = static_cast<size_t>(strands.motion_keys());
  std::vector<Box3f> at_keys(motion_keys);
  for (size_t p = 0; p < parts.count(); ++p) {
    if (keys == 1) {
      bounds.boxes.push_back(exact_bounds(strands, parts.part(p)));
      continue;
    }
    for (size_t k = 0; k < motion_keys; ++k) {
      const float time = motion_keys < 2 ? 0 : static_cast<float>(k) / static_cast<float>(motion_keys - 1);
      at_keys[k] = exact_bounds(strands, parts.part(p), time, time);
    }
    bounds.boxes.resize(bounds.boxes.size() + 2);
    interpolate_boxes(at_keys, *(bounds.boxes.end() - 2), *(bounds.boxes.end() - 1));
  }
  return bounds;
}

}  // namespace pelage
