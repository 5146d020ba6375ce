// SPDX-License-Identifier: Apache-2.0
#include "render/accel/part_bounds.h"

#include <algorithm>
#include <numeric>
#include <span>

#include "geom/curve_bounds.h"

namespace pelage {
namespace {

/// The segments of a batch, or the triangles of a skin, numbered consecutively.
class Primitives {
 public:
  explicit Primitives(const ChunkContents& contents) {
    if (const auto* fur = std::get_if<FurContents>(&contents.geometry)) {
      strands_ = &fur->strands;
      for (uint32_t s = 0; s < strands_->strand_count(); ++s) {
        const uint32_t segments = segment_count(strands_->basis(), strands_->strand_points(s));
        for (uint32_t i = 0; i < segments; ++i) places_.push_back({s, i});
      }
      places_.shrink_to_fit();
    } else {
      skin_ = &std::get<SkinMesh>(contents.geometry);
    }
  }

  size_t count() const { return strands_ ? places_.size() : skin_->triangle_count(); }
  int keys() const { return strands_ ? strands_->motion_keys() : skin_->motion_keys; }
  Box3f box(size_t i, int key) const {
    if (strands_) return hull_bounds(bezier_segment(*strands_, places_[i].strand, places_[i].segment, key));
    Box3f box;
    for (size_t corner = 0; corner < 3; ++corner) {
      box.extendBy(skin_->position(skin_->triangles[3 * i + corner], key));
    }
    return box;
  }

 private:
  struct Place {
    uint32_t strand, segment;
  };
  const Strands* strands_ = nullptr;
  std::vector<Place> places_;
  const SkinMesh* skin_ = nullptr;
};

struct Item {
  Box3f box;  // over both ends of the shutter
  uint32_t primitive = 0;
};

/// Calls `part` for `parts` runs of neighbouring items, of about equal length.
template <class Part>
void divide(std::span<Item> items, size_t parts, const Part& part) {
  if (parts <= 1 || items.size() <= 1) {
    part(items);
    return;
  }
  Box3f centres;
  for (const Item& item : items) centres.extendBy(item.box.min + item.box.max);
  const auto axis = static_cast<int>(centres.majorAxis());
  const size_t left_parts = parts / 2;
  const auto middle = static_cast<std::ptrdiff_t>(items.size() * left_parts / parts);
  std::nth_element(items.begin(), items.begin() + middle, items.end(), [axis](const Item& a, const Item& b) {
    const float ca = a.box.min[axis] + a.box.max[axis], cb = b.box.min[axis] + b.box.max[axis];
    return ca != cb ? ca < cb : a.primitive < b.primitive;
  });
  divide(items.first(static_cast<size_t>(middle)), left_parts, part);
  divide(items.subspan(static_cast<size_t>(middle)), parts - left_parts, part);
}

Box3f bounds_at(const Primitives& primitives, std::span<const Item> items, int key) {
  Box3f all;
  for (const Item& item : items) all.extendBy(primitives.box(item.primitive, key));
  return all;
}

}  // namespace

ChunkBounds part_bounds(const ChunkContents& contents, size_t segments_per_part, size_t max_parts) {
  const Primitives primitives(contents);
  const int last = primitives.keys() - 1;
  ChunkBounds bounds;
  bounds.keys = last > 0 ? 2 : 1;
  if (primitives.count() == 0) return bounds;
  std::vector<Item> items(primitives.count());
  for (uint32_t i = 0; i < items.size(); ++i) {
    items[i] = {primitives.box(i, 0), i};
    if (last > 0) items[i].box.extendBy(primitives.box(i, last));
  }
  const size_t parts = std::clamp<size_t>(items.size() / segments_per_part, 1, max_parts);
  divide(std::span(items), parts, [&](std::span<const Item> part) {
    if (last == 0) {
      Box3f box;
      for (const Item& item : part) box.extendBy(item.box);
      bounds.boxes.push_back(box);
      return;
    }
    Box3f open = bounds_at(primitives, part, 0), close = bounds_at(primitives, part, last);
    for (int key = 1; key < last; ++key) {
      hold_at(open, close, bounds_at(primitives, part, key),
              static_cast<float>(key) / static_cast<float>(last));
    }
    bounds.boxes.push_back(open);
    bounds.boxes.push_back(close);
  });
  return bounds;
}

void hold_at(Box3f& open, Box3f& close, const Box3f& inside, float time) {
  const V3f low = (1 - time) * open.min + time * close.min, high = (1 - time) * open.max + time * close.max;
  for (int i = 0; i < 3; ++i) {
    const float below = std::max(0.0f, low[i] - inside.min[i]);
    const float above = std::max(0.0f, inside.max[i] - high[i]);
    open.min[i] -= below, close.min[i] -= below;
    open.max[i] += above, close.max[i] += above;
  }
}

void widen(ChunkBounds& bounds, float margin) {
  for (Box3f& box : bounds.boxes) {
    if (!box.isEmpty()) box = Box3f(box.min - V3f(margin), box.max + V3f(margin));
  }
}

size_t part_bounds_scratch(const ChunkCounts& counts) {
  return (counts.segments + counts.triangles) * (sizeof(Item) + 4 * sizeof(uint32_t));
}

PartBoxes::PartBoxes(const ChunkBounds& bounds) : count_(bounds.part_count()) {
  FourBoxes none, still;
  for (auto& axis : none) {
    axis[0] = four(std::numeric_limits<float>::infinity());
    axis[1] = four(-std::numeric_limits<float>::infinity());
  }
  for (auto& axis : still) axis[0] = axis[1] = four(0);
  boxes_.assign((count_ + 3) / 4, none);
  if (bounds.keys > 1) motions_.assign(boxes_.size(), still);
  for (size_t part = 0; part < count_; ++part) {
    const Box3f& open = bounds.box(part, 0);
    const Box3f& close = bounds.box(part, bounds.keys - 1);
    const size_t lane = part % 4;
    for (int i = 0; i < 3; ++i) {
      auto& sides = boxes_[part / 4][static_cast<size_t>(i)];
      sides[0][lane] = open.min[i];
      sides[1][lane] = open.max[i];
      if (motions_.empty()) continue;
      auto& moves = motions_[part / 4][static_cast<size_t>(i)];
      moves[0][lane] = close.min[i] - open.min[i];
      moves[1][lane] = close.max[i] - open.max[i];
    }
  }
}

ChunkBounds PartBoxes::bounds() const {
  ChunkBounds bounds;
  bounds.keys = motions_.empty() ? 1 : 2;
  for (size_t part = 0; part < count_; ++part) {
    for (int key = 0; key < bounds.keys; ++key) {
      Box3f box;
      for (int i = 0; i < 3; ++i) {
        const auto axis = static_cast<size_t>(i);
        box.min[i] = boxes_[part / 4][axis][0][part % 4];
        box.max[i] = boxes_[part / 4][axis][1][part % 4];
        if (key == 0) continue;
        box.min[i] += motions_[part / 4][axis][0][part % 4];
        box.max[i] += motions_[part / 4][axis][1][part % 4];
      }
      bounds.boxes.push_back(box);
    }
  }
  return bounds;
}

}  // namespace pelage
