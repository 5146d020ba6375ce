// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <span>

#include "post/work_buffer.h"

namespace pelage {

/// Whether the picture is cut off at the left and right ends of a row.
struct RowEnds {
  bool left_is_cut = true, right_is_cut = true;
};

/// Marks of invented samples.
inline constexpr uint8_t kFilled = 1;    ///< in a gap, by fill_gaps
inline constexpr uint8_t kExtended = 2;  ///< beyond a side of the picture, by extend_sides

/// Fills the gaps of a row of samples, including seams, from the farther of their two borders, because a gap
/// uncovers the background. The row beyond that border is mirrored into the gap, so that a thin strand at the
/// border is copied once, with the sky beside it, and not stretched. Samples nearer than the border by more
/// than 5 % of 1 / depth are skipped. Where the row ends, or beyond twice the gap's length, the last sample
/// is repeated. At most `longest` samples of a gap are filled, starting at the border; the rest stays empty.
/// If both borders are equally far away, the left border is used. A gap at an end of the row has one border;
/// such a gap is filled if `ends` declares that the picture is cut off at this end. A row without any sample
/// stays empty.
///
/// `filled`, as long as the row, marks invented samples. Samples marked kFilled are not mirrored again.
void fill_gaps(std::span<Sample> row, std::span<uint8_t> filled, int longest, RowEnds ends = {});

}  // namespace pelage
