// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>
#include <vector>

#include "base/job.h"
#include "image/exr.h"

namespace pelage {

struct MergeParams {
  bool any_instructions = false;  ///< whether pieces may differ in `pelage:instructions`
};

/// Joins pieces of a picture: EXR files with one part each, whose data windows cover their common display
/// window exactly once. All values are copied bit for bit. The attributes of the result are those of the
/// first piece, with the sum of `pelage:renderSeconds` and the max of `pelage:peakMemoryBytes` over all
/// pieces. Returns the display window. Returns an empty box when cancelled; no file is then written.
///
/// Throws Error (kInput) naming the file: for a file that cannot be read, a partial picture, two pieces that
/// overlap, pieces whose display windows, channels or other attributes differ, and a missing piece. A foreign
/// file may lack attributes; each attribute that occurs, except the name of the part, must be
/// equal in all pieces.
PixelBox merge_pieces(const std::vector<std::filesystem::path>& pieces, const std::filesystem::path& output,
                      const MergeParams& params, const Job& job);

}  // namespace pelage
