// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "groom/cache/frozen_leaf.h"

namespace pelage {

/// The first bytes of a leaf. The tables of the columns follow, each aligned to 4 bytes, then a BlockEntry
/// for each block, then the blocks, each aligned to 16 bytes.
struct FrozenLeaf::Header {
  struct Column {
    uint8_t form = 0;
    uint8_t element_bytes = 0;
    uint16_t elements = 0;
    uint32_t entries = 0;
  };
  struct BlockEntry {
    uint16_t count = 0;
    uint16_t points = 0;
    uint32_t plain = 0;
  };
  uint32_t strands = 0;
  uint32_t blocks = 0;
  uint8_t has_base = 0;  // 1 if point 0 is stored, because the first point of some strand is not its root
  uint8_t color_rows = 0;
  uint8_t unused[6] = {};
  Column columns[StrandCodes::kColumns];
};

/// Offset of each row of a block from the first byte of the block.
struct FrozenLeaf::Layout {
  size_t row = 0;  // number of strands per row: the count, rounded up to a multiple of 8
  size_t shapes = 0, radii = 0, colors = 0, end = 0;  // radii and colors only in plain blocks
  std::array<size_t, StrandCodes::kColumns> columns{};

  Layout(const FrozenLeaf& leaf, size_t count, size_t points, bool plain) {
    row = (count + 7) / 8 * 8;
    const size_t rows = leaf.color_rows(points) * 3, shape_rows = (leaf.has_base_ ? points : points - 1) * 3;
    const auto column = [&](StrandCodes::Column kind, size_t elements) {
      columns[kind] = end;
      end += leaf.columns_[kind].block_bytes(row, elements);
    };
    if (!plain) end += row * 2;  // row of steps
    shapes = end;
    end += shape_rows * row * (plain ? 4 : 2);
    radii = end;
    if (plain) end += points * row * 4;
    colors = end;
    if (plain) end += rows * row * 4;
    column(StrandCodes::kClump, 1);
    if (!plain) {
      column(StrandCodes::kColorHue, 1);
      column(StrandCodes::kWidthScale, 1);
      column(StrandCodes::kColorScale, 1);
      column(StrandCodes::kColorProfile, rows);
      column(StrandCodes::kWidthProfile, points);
    }
    end = (end + 15) / 16 * 16;
  }
};

}  // namespace pelage
