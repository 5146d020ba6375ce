// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <span>

#include "post/flow_field.h"
#include "post/warp.h"
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

/// Extends one row of a picture beyond each side where `cut` declares that the picture is cut off. The row of
/// the field is mirrored at this side. Each mirrored pixel keeps its depth and motion. If a sky moves farther
/// than a surface in front of it, mirrored sky appears behind this surface, as it would in a wider picture.
///
/// `line`: sample row `row` of the result, from column 0 on, after the warp to time 1. Each empty sample
/// becomes the nearest of the mirrored pixels that move to it, and is marked kExtended in `filled`. Samples
/// that no mirrored pixel reaches stay empty. `max`: max number of pixels to mirror at each side.
void extend_sides(const FlowField& field, const WarpTarget& target, RowEnds cut, int max, int row,
                  std::span<Sample> line, std::span<uint8_t> filled);

}  // namespace pelage
