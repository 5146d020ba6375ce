// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <span>

#include "render/accel/fur/fur_reference.h"

namespace pelage {

/// An axis-aligned box in grid units; inverted when empty.
struct FurBox {
  std::array<float, 3> low{1e30f, 1e30f, 1e30f};
  std::array<float, 3> high{-1e30f, -1e30f, -1e30f};

  void extend(const FurBox& o);
  bool is_empty() const { return low[0] > high[0]; }
  /// Half of the surface area; 0 if the box is empty.
  double area() const;
};

struct FurChild {
  FurReference reference;
  std::span<const FurBox> boxes;  ///< one per motion key
};

/// Byte offsets in a node. The boxes of the four children are 8-bit coordinates on a grid of the node;
/// without motion, a node has 64 bytes. The node has the origin of its grid (three axes), the scale of its
/// grid (three axes) and the references to the children. For each motion key and axis, the low sides of the
/// children's boxes follow and then their high sides, one byte per side.
struct FurQuantisedNode {
  static constexpr size_t kOrigin = 0, kScale = 12, kReferences = 24, kPlanes = 40;
  static constexpr size_t kKey = 24, kAxis = 8, kSide = 4;
  static constexpr size_t size(int motion_keys) {
    return (kPlanes + kKey * static_cast<size_t>(motion_keys) + 15) / 16 * 16;
  }
};

/// Writes a node with 1 to 4 children. The decoded boxes contain the given boxes, up to the rounding errors
/// of one product and one sum in the decoder.
void write_node(int motion_keys, std::span<const FurChild> children, std::byte* out);

/// Returns the reference to child `i` of a node written by write_node(). If the node has no such child,
/// is_none() of the reference is true.
FurReference child_reference(const std::byte* node, size_t i);
/// Returns the box of child `i` at one key. Its sides are moved outward by the rounding error of decoding, so
/// the box contains the box given to write_node().
FurBox child_box(const std::byte* node, size_t i, int key);

}  // namespace pelage
