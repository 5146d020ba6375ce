// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>
#include <vector>

#include "image/exr_file.h"

namespace pelage {

/// A file that holds a piece of a picture: its data window inside the display window of the picture.
struct PieceHeader {
  std::filesystem::path path;
  ExrPart part;
};

/// Reads the headers of pieces and checks that they belong together and cover their picture exactly once.
/// `any_instructions`: whether they may differ in `pelage:instructions`. Throws Error (kInput) naming the
/// piece that cannot be read, is partial, differs, overlaps, or the pixels that no piece contains.
std::vector<PieceHeader> read_pieces(const std::vector<std::filesystem::path>& paths, bool any_instructions);

/// Returns the header of the merged picture. It is the header of the first piece, but `pelage:renderSeconds`
/// is the sum over all pieces, `pelage:peakMemoryBytes` the max, and `pelage:instructions` is "mixed" if
/// pieces differ.
ExrPart merged_header(const std::vector<PieceHeader>& pieces);

/// Returns whether `output` already is the picture that merge_pieces() would write: it is newer than every
/// piece, and has the header that merged_header() returns. Returns false if read_pieces() would throw.
bool is_merged(const std::vector<std::filesystem::path>& pieces, const std::filesystem::path& output,
               bool any_instructions);

}  // namespace pelage
