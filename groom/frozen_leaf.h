// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>
#include <span>
#include <vector>

#include "groom/strand_batch.h"

namespace pelage {

/// How the widths and colours of a leaf are kept.
enum class FrozenClass : uint8_t {
  kNone,       ///< as before the first operator
  kConstant,   ///< one profile over the points for all strands, exact
  kSeparable,  ///< the profile times 16 bits per strand
  kFull,       ///< 8 bits per point and 16 per strand; colours of whole strands: 16 bits per channel
};

/// The strands of a leaf after the frozen operators, read from bytes that stay where they are.
///
/// Blocks of at most kBlockStrands strands in the leaf's order, each with rows over its strands, so that a
/// prefix of the strands is a prefix of the bytes. Shapes are in the follicle frame of the rest skin: 16 bits
/// per component and point, each point from the decoded one before in steps of the strand's own, so that no
/// point is further than 0.87 steps from its place and a step is the 32766th part of the strand's longest
/// segment (largest component). A leaf where that is more than a twentieth of some strand's width keeps
/// floats. Widths: kSeparable to 1e-4 of the strand's and 1/131070 of the leaf's widest, kFull to 1/510 of
/// the strand's widest. Colours: the same by channel, but kFull per point has the square roots in 8 bits.
/// Immutable. Thread safety: const members may be called from any thread.
class FrozenLeaf {
 public:
  struct Block {
    uint32_t first = 0;  ///< strand of the leaf
    uint32_t count = 0;
    int points = 0;
    size_t data = 0;  ///< where its rows begin
  };

  /// Nothing when the bytes are not those of a leaf. `bytes` must be 16-byte aligned.
  static std::optional<FrozenLeaf> read(std::span<const std::byte> bytes);

  size_t strand_count() const { return strands_; }
  std::span<const Block> blocks() const { return blocks_; }
  size_t bytes() const { return bytes_.size(); }
  bool is_wide() const { return wide_; }
  FrozenClass widths() const { return width_class_; }
  FrozenClass colors() const { return color_class_; }

  /// Radii, colours and clump numbers of the first batch.count strands of a block; ids must be set. What the
  /// leaf does not hold stays as it is, but for clump numbers, which are those of strands in no clump.
  void attributes(const Block& block, StrandBatch& batch) const;
  /// Offsets of the same along the axes of `frames`' space, times `scale`.
  void shape(const Block& block, const RootRows& frames, float scale, StrandBatch& batch) const;

 private:
  friend class FrozenLeafWriter;
  struct Header;
  struct Layout;

  std::span<const std::byte> bytes_;
  std::vector<Block> blocks_;
  std::vector<float> width_profile_, color_profile_;
  size_t strands_ = 0;
  size_t color_rows_ = 0;
  float width_step_ = 0;
  float color_step_[3] = {};
  FrozenClass width_class_ = FrozenClass::kNone, color_class_ = FrozenClass::kNone;
  bool wide_ = false, has_base_ = false, has_clump_ = false;
};

}  // namespace pelage
