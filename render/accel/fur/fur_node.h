// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <span>

#include "render/accel/fur/fur_reference.h"

namespace pelage {

/// How nodes store the boxes of their four children: as floats, 128 bytes in total [Neulander13], or as 8-bit
/// numbers on a grid per node, 64 bytes.
enum class FurNodeLayout : uint8_t { kFloat, kQuantised };

/// An axis-aligned box in grid units; inverted when empty.
struct FurBox {
  std::array<float, 3> low{1e30f, 1e30f, 1e30f};
  std::array<float, 3> high{-1e30f, -1e30f, -1e30f};

  void extend(const FurBox& o);
  bool is_empty() const { return low[0] > high[0]; }
  /// Half of the surface area.
  double area() const;
};

struct FurChild {
  FurReference reference;
  std::span<const FurBox> boxes;  ///< one per motion key
};

/// Float layout: by motion key and axis, the low and then the high sides of four children; then their
/// references, starting at references().
struct FurFloatNode {
  static constexpr size_t kKey = 96, kAxis = 32, kSide = 16;
  static constexpr size_t references(int motion_keys) { return kKey * static_cast<size_t>(motion_keys); }
  static constexpr size_t size(int motion_keys) { return (references(motion_keys) + 16 + 63) / 64 * 64; }
};

/// Quantised layout: origin and scale of the three axes, references, and by motion key and axis the low and
/// then the high sides of four children, one byte each.
struct FurQuantisedNode {
  static constexpr size_t kOrigin = 0, kScale = 12, kReferences = 24, kPlanes = 40;
  static constexpr size_t kKey = 24, kAxis = 8, kSide = 4;
  static constexpr size_t size(int motion_keys) {
    return (kPlanes + kKey * static_cast<size_t>(motion_keys) + 15) / 16 * 16;
  }
};

size_t node_size(FurNodeLayout layout, int motion_keys);
/// Writes a node of 1 to 4 children. The decoded boxes contain the given ones, up to the rounding of one
/// product and one sum.
void write_node(FurNodeLayout layout, int motion_keys, std::span<const FurChild> children, std::byte* out);

/// Child `i` of a node written by write_node(); FurReference::is_none() if the node has fewer children.
FurReference child_reference(FurNodeLayout layout, int motion_keys, const std::byte* node, size_t i);
void set_child_reference(FurNodeLayout layout, int motion_keys, std::byte* node, size_t i,
                         FurReference reference);
/// The box of child `i` at one key as used by ray tracing; contains the box that was written, including
/// rounding.
FurBox child_box(FurNodeLayout layout, const std::byte* node, size_t i, int key);

}  // namespace pelage
