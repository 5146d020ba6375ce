// SPDX-License-Identifier: Apache-2.0
#include "render/accel/fur/fur_node.h"

#include <algorithm>
#include <cmath>
#include <cstring>
#include <limits>

namespace pelage {
namespace {

constexpr float kInfiniteBound = std::numeric_limits<float>::infinity();
constexpr float kMaxGridStep = 255;

/// The largest step from which origin + step * scale does not exceed `low`.
uint8_t step_below(float low, float origin, float scale) {
  float step = std::clamp(std::floor((low - origin) / scale), 0.0f, kMaxGridStep);
  while (step > 0 && origin + step * scale > low) --step;
  return static_cast<uint8_t>(step);
}

uint8_t step_above(float high, float origin, float scale) {
  float step = std::clamp(std::ceil((high - origin) / scale), 0.0f, kMaxGridStep);
  while (step < kMaxGridStep && origin + step * scale < high) ++step;
  return static_cast<uint8_t>(step);
}

}  // namespace

void FurBox::extend(const FurBox& o) {
  for (size_t i = 0; i < 3; ++i) {
    low[i] = std::min(low[i], o.low[i]);
    high[i] = std::max(high[i], o.high[i]);
  }
}

double FurBox::area() const {
  if (is_empty()) return 0;
  const double x = double(high[0]) - low[0], y = double(high[1]) - low[1], z = double(high[2]) - low[2];
  return x * y + y * z + z * x;
}

void write_node(int motion_keys, std::span<const FurChild> children, std::byte* out) {
  std::memset(out, 0, FurQuantisedNode::size(motion_keys));
  FurBox whole;
  for (const FurChild& child : children) {
    for (const FurBox& box : child.boxes) whole.extend(box);
  }
  float scale[3];
  for (size_t axis = 0; axis < 3; ++axis) {
    const float extent = whole.high[axis] - whole.low[axis];
    // Slightly larger than needed, so that the last step is beyond the high side in float as well; and not
    // below the precision of float there.
    const float reach = std::max(std::abs(whole.low[axis]), std::abs(whole.high[axis]));
    scale[axis] = std::max({extent / (kMaxGridStep - 1), reach * 0x1p-23f, 0x1p-40f});
  }
  uint32_t references[4] = {};
  for (size_t i = 0; i < children.size(); ++i) references[i] = children[i].reference.bits();
  std::memcpy(out + FurQuantisedNode::kOrigin, whole.low.data(), sizeof(scale));
  std::memcpy(out + FurQuantisedNode::kScale, scale, sizeof(scale));
  std::memcpy(out + FurQuantisedNode::kReferences, references, sizeof(references));
  for (size_t key = 0; key < static_cast<size_t>(motion_keys); ++key) {
    for (size_t axis = 0; axis < 3; ++axis) {
      uint8_t sides[2][4];
      for (size_t i = 0; i < 4; ++i) {
        const bool there = i < children.size();
        sides[0][i] =
            there ? step_below(children[i].boxes[key].low[axis], whole.low[axis], scale[axis]) : 255;
        sides[1][i] = there ? step_above(children[i].boxes[key].high[axis], whole.low[axis], scale[axis]) : 0;
      }
      std::memcpy(
          out + FurQuantisedNode::kPlanes + key * FurQuantisedNode::kKey + axis * FurQuantisedNode::kAxis,
          sides, sizeof(sides));
    }
  }
}

FurReference child_reference(const std::byte* node, size_t i) {
  uint32_t bits = 0;
  std::memcpy(&bits, node + FurQuantisedNode::kReferences + i * sizeof(bits), sizeof(bits));
  return FurReference::from_bits(bits);
}

FurBox child_box(const std::byte* node, size_t i, int key) {
  FurBox box;
  const auto k = static_cast<size_t>(key);
  for (size_t axis = 0; axis < 3; ++axis) {
    float origin = 0, scale = 0;
    uint8_t sides[2][4];
    std::memcpy(&origin, node + FurQuantisedNode::kOrigin + axis * sizeof(float), sizeof(float));
    std::memcpy(&scale, node + FurQuantisedNode::kScale + axis * sizeof(float), sizeof(float));
    std::memcpy(
        sides, node + FurQuantisedNode::kPlanes + k * FurQuantisedNode::kKey + axis * FurQuantisedNode::kAxis,
        sizeof(sides));
    box.low[axis] = std::nextafter(origin + static_cast<float>(sides[0][i]) * scale, -kInfiniteBound);
    box.high[axis] = std::nextafter(origin + static_cast<float>(sides[1][i]) * scale, kInfiniteBound);
  }
  return box;
}

}  // namespace pelage
