// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <algorithm>
#include <filesystem>
#include <vector>

#include "image/exr.h"
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

/// Returns the common pixels of two boxes; a box without pixels if they have none.
inline PixelBox common_pixels(const PixelBox& a, const PixelBox& b) {
  const PixelBox box{std::max(a.x0, b.x0), std::max(a.y0, b.y0), std::min(a.x1, b.x1), std::min(a.y1, b.y1)};
  return box.width() > 0 && box.height() > 0 ? box : PixelBox{};
}

/// Returns boxes that together contain each pixel of `frame` that no box of `covered` contains, once.
inline std::vector<PixelBox> uncovered_boxes(const PixelBox& frame, const std::vector<PixelBox>& covered) {
  std::vector<PixelBox> left{frame};
  for (const PixelBox& cover : covered) {
    std::vector<PixelBox> rest;
    for (const PixelBox& box : left) {
      const PixelBox cut = common_pixels(box, cover);
      if (cut.width() == 0) {
        rest.push_back(box);
        continue;
      }
      for (const PixelBox& part :
           {PixelBox{box.x0, box.y0, box.x1, cut.y0}, PixelBox{box.x0, cut.y0, cut.x0, cut.y1},
            PixelBox{cut.x1, cut.y0, box.x1, cut.y1}, PixelBox{box.x0, cut.y1, box.x1, box.y1}}) {
        if (part.width() > 0 && part.height() > 0) rest.push_back(part);
      }
    }
    left = std::move(rest);
  }
  return left;
}

}  // namespace pelage
