// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <span>

#include "post/work_buffer.h"

namespace pelage {

/// Whether the picture is cut off at the ends of a row, rather than over.
struct RowEnds {
  bool left_is_cut = true, right_is_cut = true;
};

/// Fills the gaps of a row of samples, seams among them, from the farther one of their two borders, because
/// what a gap uncovers lies behind. From that border on, what is seen is mirrored into the gap for as long as
/// it goes on at about that depth; then its last sample is drawn out. At most `longest` samples of a gap are
/// filled, beginning at the border; the rest stays empty. Equally far borders: the left one. A gap at an end
/// of the row has one border; it is filled where `ends` says that the picture is cut off there. A row without
/// any sample stays empty.
///
/// `invented`, as long as the row and zero at first, becomes 1 where a sample was filled.
void fill_gaps(std::span<Sample> row, std::span<uint8_t> invented, int longest, RowEnds ends = {});

}  // namespace pelage
