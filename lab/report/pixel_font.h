// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cstdint>

namespace pelage {

inline constexpr int kGlyphColumns = 5, kGlyphRows = 7;
/// Columns from the left; the lowest bit is the upper row.
using Glyph = std::array<uint8_t, kGlyphColumns>;

/// A printable ASCII character; a box for everything else.
const Glyph& pixel_glyph(char c);

}  // namespace pelage
