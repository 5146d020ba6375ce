// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <span>
#include <vector>

#include "groom/cache/code_column.h"
#include "groom/cache/strand_codes.h"
#include "groom/strands/strand_batch.h"

namespace pelage {

/// The strands of a leaf in their state after the frozen operators. Read directly from stored bytes, without
/// a copy.
///
/// A leaf consists of blocks of at most kBlockStrands strands, in the leaf's order. Within a block, the data
/// is in rows over the strands of the block. The first blocks of a leaf are therefore its first bytes. Every
/// stored value depends on its strand alone (groom/cache/strand_codes.h). Only the encoding of values depends
/// on the other strands of the leaf.
///
/// Shapes are in the follicle frame of the rest skin, with 16 bits per component of a point. A point is
/// stored relative to the previous decoded point, as a multiple of a step. The size of the step is chosen per
/// strand: 1/32766 of the largest component of the strand's segments, rounded up by at most a factor of 1 +
/// 2^-10. The error of a point is at most 0.87 steps.
///
/// The max width of a strand has a relative error of at most 2^-11. The width at a point has an error of at
/// most 1/510 of the max width, or 1/131070 if all strands share one width profile. Colours, at points and at
/// roots, have an error of at most 0.0015 of the largest channel of the strand.
///
/// A block is stored in floats if this encoding would move one of its strands by more than a twentieth of the
/// strand's width, or if a value is too large for the encoding.
///
/// Immutable. Thread safety: const members may be called from any thread.
class FrozenLeaf {
 public:
  struct Block {
    uint32_t first = 0;  ///< index in the leaf of its first strand
    uint32_t count = 0;
    int points = 0;
    bool plain = false;  ///< stored in floats
    size_t data = 0;     ///< offset of its rows in the bytes
  };

  /// Reads a leaf from `bytes`, which must be aligned to 16 bytes. Empty when they do not encode a leaf.
  static std::optional<FrozenLeaf> read(std::span<const std::byte> bytes);

  size_t strand_count() const { return strands_; }
  std::span<const Block> blocks() const { return blocks_; }
  size_t bytes() const { return bytes_.size(); }
  bool has_colors() const { return color_rows_ != ColorRows::kNone; }
  /// How the codes of one kind are encoded in this leaf.
  const CodeColumn& column(StrandCodes::Column kind) const { return columns_[kind]; }

  /// Sets the radii, colours and clump numbers of the first batch.count strands of a block. The ids of the
  /// batch must be set. Radii and colours that the leaf does not store stay unchanged. If the leaf does not
  /// store clump numbers, sets those of unclumped strands.
  void attributes(const Block& block, StrandBatch& batch) const;
  /// Sets the offsets of the first batch.count strands of a block: along the axes of `frames`, times `scale`.
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
