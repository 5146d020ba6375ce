// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <span>
#include <vector>

#include "groom/code_column.h"
#include "groom/strand_batch.h"
#include "groom/strand_codes.h"

namespace pelage {

/// The strands of a leaf after the frozen operators, read in place from bytes.
///
/// Consists of blocks of at most kBlockStrands strands, in the leaf's order. A block has rows over its
/// strands. A prefix of the blocks is therefore a prefix of the bytes. Every number is a function of its
/// strand alone (groom/strand_codes.h); only its encoding depends on the leaf.
///
/// Shapes are in the follicle frame of the rest skin, with 16 bits per component and point. Each point is
/// stored relative to the previous decoded point, in steps whose size is chosen per strand. The error of a
/// point is at most 0.87 steps. A step is 1/32766 of the strand's longest segment (largest component), or up
/// to 2^-10 more. The max width of a strand has a relative error of at most 2^-11. The width at a point has
/// an error of at most 1/510 of the max width, or 1/131070 if all strands share one profile. Colours, at each
/// point and at the root, have an error of at most 0.0015 of the strand's brightest channel. If this encoding
/// would move a strand by more than a twentieth of its width, or its numbers are too large, its whole block
/// is stored in floats.
///
/// Immutable. Thread safety: const members may be called from any thread.
class FrozenLeaf {
 public:
  struct Block {
    uint32_t first = 0;  ///< index of its first strand in the leaf
    uint32_t count = 0;
    int points = 0;
    bool plain = false;  ///< in floats
    size_t data = 0;     ///< offset of its rows
  };

  /// Empty when the bytes do not encode a leaf. `bytes` must be 16-byte aligned.
  static std::optional<FrozenLeaf> read(std::span<const std::byte> bytes);

  size_t strand_count() const { return strands_; }
  std::span<const Block> blocks() const { return blocks_; }
  size_t bytes() const { return bytes_.size(); }
  bool has_colors() const { return color_rows_ != ColorRows::kNone; }
  /// Encoding of one kind of code.
  const CodeColumn& column(StrandCodes::Column kind) const { return columns_[kind]; }

  /// Radii, colours and clump numbers of the first batch.count strands of a block; ids must be set.
  /// Attributes that the leaf does not store stay unchanged, except for clump numbers, which are set as for
  /// unclumped strands.
  void attributes(const Block& block, StrandBatch& batch) const;
  /// Offsets of the same strands along the axes of `frames`, times `scale`.
  void shape(const Block& block, const RootRows& frames, float scale, StrandBatch& batch) const;

 private:
  friend class FrozenLeafWriter;
  enum class ColorRows : uint8_t { kNone, kPerStrand, kPerPoint };
  struct Header;
  struct Layout;

  size_t color_rows(size_t points) const {
    return color_rows_ == ColorRows::kNone ? 0 : color_rows_ == ColorRows::kPerStrand ? 1 : points;
  }
  void radii(const Block& block, const Layout& layout, StrandBatch& batch) const;
  void colors(const Block& block, const Layout& layout, StrandBatch& batch) const;

  std::span<const std::byte> bytes_;
  std::vector<Block> blocks_;
  std::array<CodeColumn, StrandCodes::kColumns> columns_;
  std::vector<float> width_table_, color_table_;  // decoded tables of the profiles
  size_t strands_ = 0;
  ColorRows color_rows_ = ColorRows::kNone;
  bool has_base_ = false;
};

}  // namespace pelage
