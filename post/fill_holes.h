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

/// Marks of samples that were made.
inline constexpr uint8_t kFilled = 1;    ///< in a gap, by fill_gaps
inline constexpr uint8_t kExtended = 2;  ///< beyond a side of the picture, by extend_sides

/// Fills the gaps of a row of samples, seams among them, from the farther one of their two borders, because
/// a gap uncovers the background. From that border on, the row is mirrored into the gap, without whatever is
/// nearer than the border by more than 5 % of 1 / depth: of a thin strand before a sky, the strand and the
/// sky beside it are mirrored, and the strand is not stretched. Where the row ends, or twice the gap's
/// length away, the last sample is repeated. At most `longest` samples of a gap are filled, beginning at the
/// border; the rest stays empty. Equally far borders: the left one. A gap at an end of the row has one
/// border; it is filled where `ends` says that the picture is cut off there. A row without any sample stays
/// empty.
///
/// `filled`, as long as the row, marks samples that were made; those of kFilled are not mirrored again.
void fill_gaps(std::span<Sample> row, std::span<uint8_t> filled, int longest, RowEnds ends = {});

}  // namespace pelage
