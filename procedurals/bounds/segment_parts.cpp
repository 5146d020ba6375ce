// SPDX-License-Identifier: Apache-2.0
#include "procedurals/bounds/segment_parts.h"

#include <algorithm>
#include <bit>
#include <cmath>

#include "geom/curve_bounds.h"

namespace pelage {

/// A segment while cells are built.
struct SegmentParts::Item {
  float middle[3];  // times two
  uint32_t number;
};

SegmentParts::SegmentParts(const Strands& strands, const SegmentDivision& division)
    : strands_(strands), division_(division) {
  std::vector<SegmentPlace> places;
  for (uint32_t strand = 0; strand < strands.strand_count(); ++strand) {
    const uint32_t segments = segment_count(strands.basis(), strands.strand_points(strand));
    for (uint32_t segment = 0; segment < segments; ++segment) places.push_back({strand, segment});
  }
  const size_t count = places.size();
  if (count == 0) return;
  const auto keys = static_cast<size_t>(strands.motion_keys());
  std::vector<Box3f> hulls;
  hulls.reserve(keys * count);
  for (int key = 0; key < strands.motion_keys(); ++key) {
    for (size_t strand = 0; strand < strands.strand_count(); ++strand) {
      append_hull_bounds(strands, strand, key, hulls);
    }
  }
  std::vector<Item> items(count);
  for (size_t i = 0; i < count; ++i) {
    const V3f middle = hulls[i].min + hulls[i].max;
    items[i] = {{middle.x, middle.y, middle.z}, static_cast<uint32_t>(i)};
  }
  order_.resize(count);
  cells_ = (count + division.cell_segments - 1) / division.cell_segments;
  divide(items, 0, cells_);
  hulls_.resize(hulls.size());
  for (size_t i = 0; i < count; ++i) {
    order_[i] = places[items[i].number];
    for (size_t key = 0; key < keys; ++key) hulls_[key * count + i] = hulls[key * count + items[i].number];
  }
}

void SegmentParts::divide(std::span<Item> items, size_t first_cell, size_t last_cell) {
  if (last_cell - first_cell < 2) return;
  float low[3], high[3];
  std::copy_n(items.front().middle, 3, low);
  std::copy_n(items.front().middle, 3, high);
  for (const Item& item : items) {
    for (int axis = 0; axis < 3; ++axis) {
      low[axis] = std::min(low[axis], item.middle[axis]);
      high[axis] = std::max(high[axis], item.middle[axis]);
    }
  }
  int axis = 0;
  for (int i = 1; i < 3; ++i) {
    if (high[i] - low[i] > high[axis] - low[axis]) axis = i;
  }
  const size_t half = std::bit_floor(last_cell - first_cell - 1);
  const size_t left = begin_of(first_cell + half) - begin_of(first_cell);
  std::nth_element(items.begin(), items.begin() + static_cast<ptrdiff_t>(left), items.end(),
                   [axis](const Item& a, const Item& b) {
                     return a.middle[axis] != b.middle[axis] ? a.middle[axis] < b.middle[axis]
                                                             : a.number < b.number;
                   });
  divide(items.first(left), first_cell, first_cell + half);
  divide(items.subspan(left), first_cell + half, last_cell);
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
    // Interpolation in float rounds three times.
    const float rounding = 0x1p-21f * largest;
    for (Box3f* box : {&open, &close}) {
      box->min[axis] -= static_cast<float>(below) + rounding;
      box->max[axis] += static_cast<float>(above) + rounding;
    }
  }
}

Box3f SegmentParts::exact_box(size_t part, std::span<const int> keys) const {
  const std::span<const SegmentPlace> segments = this->part(part);
  const auto first = static_cast<size_t>(segments.data() - order_.data());
  Box3f box;
  for (const int key : keys) {
    for (size_t i = 0; i < segments.size(); ++i) {
      // Most segments lie inside the bounds of the first few.
      const Box3f& hull = this->hull(static_cast<size_t>(key), first + i);
      if (box.intersects(hull.min) && box.intersects(hull.max)) continue;
      box.extendBy(
          pelage::exact_bounds(bezier_segment(strands_, segments[i].strand, segments[i].segment, key)));
    }
  }
  return box;
}

ChunkBounds SegmentParts::exact_bounds(int keys) const {
  ChunkBounds bounds;
  bounds.keys = keys;
  if (cells_ == 0) return bounds;
  std::vector<int> motion_keys(static_cast<size_t>(strands_.motion_keys()));
  for (size_t k = 0; k < motion_keys.size(); ++k) motion_keys[k] = static_cast<int>(k);

  std::vector<Box3f> at_keys(motion_keys.size());
  for (size_t p = 0; p < part_count(); ++p) {
    if (keys == 1) {
      bounds.boxes.push_back(exact_box(p, motion_keys));
      continue;
    }
    for (const int k : motion_keys) at_keys[static_cast<size_t>(k)] = exact_box(p, std::span(&k, 1));
    bounds.boxes.resize(bounds.boxes.size() + 2);
    interpolate_boxes(at_keys, *(bounds.boxes.end() - 2), *(bounds.boxes.end() - 1));
  }

  // One box over all keys, or one per key.
  const size_t boxes_per_cell = keys == 1 ? 1 : motion_keys.size();
  std::vector<Box3f> cells(cells_ * boxes_per_cell);
  for (size_t c = 0; c < cells_; ++c) {
    for (size_t key = 0; key < motion_keys.size(); ++key) {
      Box3f& box = cells[c * boxes_per_cell + key % boxes_per_cell];
      for (size_t i = begin_of(c); i < begin_of(c + 1); ++i) box.extendBy(hull(key, i));
    }
  }
  bounds.cell_bounds = SegmentCellBounds(cells, boxes_per_cell);
  return bounds;
}

size_t SegmentParts::bytes_bound(size_t segments, size_t motion_keys) {
  return segments * (3 * sizeof(SegmentPlace) + sizeof(Item) + 2 * motion_keys * sizeof(Box3f));
}

}  // namespace pelage
