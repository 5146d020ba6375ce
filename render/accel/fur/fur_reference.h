// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>

namespace pelage {

/// Refers to a child of a node, in 32 bits. A reference stays valid when the tree is moved in memory, because
/// it is an offset: from the start of the nodes for an inner node, and from the start of the leaves for a
/// leaf. The unit of offsets is 16 bytes.
///
/// Bits of an inner node, highest first: 0, then 31 bits of offset. Bits of a leaf: 1, then 1 bit of
/// is_wide(), 2 bits of blocks() - 1, and 28 bits of offset. The root has offset 0 but is never a child, so
/// the value 0 means that there is no child.
class FurReference {
 public:
  static constexpr uint32_t kUnit = 16;
  static constexpr uint64_t kLeafReach = uint64_t(kUnit) << 28;
  static constexpr uint64_t kNodeReach = uint64_t(kUnit) << 31;

  FurReference() = default;
  static FurReference to_node(uint64_t offset) { return FurReference(static_cast<uint32_t>(offset / kUnit)); }
  static FurReference to_leaf(uint64_t offset, uint32_t blocks, bool wide) {
    return FurReference(1u << 31 | (wide ? 1u << 30 : 0u) | (blocks - 1) << 28 |
                        static_cast<uint32_t>(offset / kUnit));
  }
  static FurReference from_bits(uint32_t bits) { return FurReference(bits); }

  uint32_t bits() const { return bits_; }
  bool is_none() const { return bits_ == 0; }
  bool is_leaf() const { return bits_ >> 31 != 0; }
  bool is_wide() const { return (bits_ >> 30 & 1) != 0; }
  uint32_t blocks() const { return (bits_ >> 28 & 3) + 1; }
  uint64_t node_offset() const { return uint64_t(bits_) * kUnit; }
  uint64_t leaf_offset() const { return uint64_t(bits_ & 0xfffffff) * kUnit; }

 private:
  explicit FurReference(uint32_t bits) : bits_(bits) {}
  uint32_t bits_ = 0;
};

}  // namespace pelage
