// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <span>

#include "post/work_buffer.h"

namespace pelage {

/// Tells at which ends of a row the picture is cut off, so that the scene continues beyond it.
struct RowEnds {
  bool left_is_cut = true, right_is_cut = true;
};

/// Marks of invented samples; 0 marks samples that the source shows.
inline constexpr uint8_t kFilled = 1;    ///< a sample in a gap, invented by fill_gaps()
inline constexpr uint8_t kExtended = 2;  ///< a sample beyond a side of the source, invented by extend_sides()

/// Fills the gaps of a row of samples. A gap is a run of empty samples and seams between two borders, which
/// are the samples at its left and right ends. The gap is filled from the border that is farther away,
/// because a gap uncovers the background. If both borders are equally far away, the gap is filled from the
/// left.
///
/// The samples on the other side of this border are mirrored into the gap. Thus a thin strand at the border
/// is copied once, with the sky beside it, and not stretched. Samples that are nearer than the border by more
/// than 5 % of 1 / depth are skipped. At the end of the row, and beyond twice the filled length, the last
/// mirrored sample is repeated. At most `longest` samples of a gap are filled, starting at the border. The
/// rest of the gap becomes empty.
///
/// A gap at an end of the row has only one border. This gap is filled only if `ends` declares that the
/// picture is cut off at this end. A row without any sample stays empty.
///
/// `filled` has one mark per sample of the row, and receives kFilled for each filled sample. Samples marked
/// kFilled are not mirrored again.
void fill_gaps(std::span<Sample> row, std::span<uint8_t> filled, int longest, RowEnds ends = {});

}  // namespace pelage
