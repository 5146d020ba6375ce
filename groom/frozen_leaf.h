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

/// The strands of a leaf after the frozen operators, read from bytes that stay where they are.
///
/// Blocks of at most kBlockStrands strands in the leaf's order, each with rows over its strands, so that a
/// prefix of the strands is a prefix of the bytes. Every number is a function of its strand alone
/// (groom/strand_codes.h); only how it is written down depends on the leaf. Shapes are in the follicle frame
/// of the rest skin: 16 bits per component and point, each point from the decoded one before in steps of the
/// strand's own, so that no point is further than 0.87 steps from its place; a step is the 32766th part of
/// the strand's longest segment (largest component), and at most 2^-10 more. Widths: the strand's widest to
/// 2^-11 of it, and each point to 1/510 of the widest, or 1/131070 where all strands have one profile.
/// Colours: each point to 0.0015 of the strand's brightest channel, and its root to as much. Strands that
/// this would move by more than a twentieth of their width, or that have larger numbers, are kept in floats,
/// and with them their block. Immutable. Thread safety: const members may be called from any thread.
class FrozenLeaf {
 public:
  struct Block {
    uint32_t first = 0;  ///< strand of the leaf
    uint32_t count = 0;
    int points = 0;
    bool plain = false;  ///< in floats
    size_t data = 0;     ///< where its rows begin
  };

  /// Nothing when the bytes are not those of a leaf. `bytes` must be 16-byte aligned.
  static std::optional<FrozenLeaf> read(std::span<const std::byte> bytes);

  size_t strand_count() const { return strands_; }
  std::span<const Block> blocks() const { return blocks_; }
  size_t bytes() const { return bytes_.size(); }
  bool has_colors() const { return color_rows_ != ColorRows::kNone; }
  /// How the codes of a kind are written.
  const CodeColumn& column(StrandCodes::Column kind) const { return columns_[kind]; }

  /// Radii, colours and clump numbers of the first batch.count strands of a block; ids must be set. What the
  /// leaf does not hold stays as it is, but for clump numbers, which are those of strands in no clump.
  void attributes(const Block& block, StrandBatch& batch) const;
  /// Offsets of the same along the axes of `frames`' space, times `scale`.
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
  std::vector<float> width_table_, color_table_;  // of the profiles' tables, decoded
  size_t strands_ = 0;
  ColorRows color_rows_ = ColorRows::kNone;
  bool has_base_ = false;
};

}  // namespace pelage
