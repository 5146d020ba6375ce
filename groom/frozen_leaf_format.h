// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "groom/frozen_leaf.h"

namespace pelage {

/// First bytes of a leaf. Behind it: the width profile, the colour profile (floats), {count, points} of each
/// block (16 bits each), and from the next multiple of 16 on the blocks.
struct FrozenLeaf::Header {
  uint32_t strands = 0;
  uint32_t blocks = 0;
  uint8_t wide = 0;       // shapes are floats
  uint8_t has_base = 0;   // point 0 is kept: strands whose first point is not their root
  uint8_t has_clump = 0;  // clump numbers are kept
  uint8_t width_class = 0;
  uint8_t color_class = 0;
  uint8_t unused[3] = {};
  uint32_t width_points = 0;  // of the width profile
  uint32_t color_rows = 0;    // 1 or as many as points
  float width_step = 0;       // what 1 of 65535 measures
  float color_step[3] = {};
  uint32_t color_profile_rows = 0;
  uint32_t reserved = 0;
};

/// Where the rows of a block stand, from its first byte on.
struct FrozenLeaf::Layout {
  size_t row = 0;  // strands of a row: the count, rounded up to 8
  size_t steps = 0, shapes = 0, clumps = 0, widths = 0, colors = 0, end = 0;

  Layout(const FrozenLeaf& leaf, size_t count, int points) {
    const auto n = static_cast<size_t>(points);
    row = (count + 7) / 8 * 8;
    shapes = leaf.wide_ ? 0 : row * 4;
    clumps = shapes + (leaf.has_base_ ? n : n - 1) * 3 * row * (leaf.wide_ ? 4 : 2);
    widths = clumps + (leaf.has_clump_ ? row * 2 : 0);
    colors = widths;
    if (leaf.width_class_ == FrozenClass::kSeparable) colors += row * 2;
    if (leaf.width_class_ == FrozenClass::kFull) colors += row * 2 + row * n;
    end = colors;
    if (leaf.color_class_ == FrozenClass::kSeparable) end += row * 2;
    if (leaf.color_class_ == FrozenClass::kFull)
      end += leaf.color_rows_ == 1 ? row * 6 : row * 3 * leaf.color_rows_;
    end = (end + 15) / 16 * 16;
  }
};

}  // namespace pelage
