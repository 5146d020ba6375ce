// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>
#include <optional>
#include <vector>

#include "image/exr.h"
#include "lab/pictures/error_region.h"

namespace pelage {

/// One frame, reduced to blocks of 8 x 8 pixels. Pixel values are means of R, G and B.
struct FrameBlocks {
  Plane means;
  Plane region;  ///< fraction of the pixels of a block that are in the region
};
/// Empty when the picture lacks R, G, B or the layer of the region.
std::optional<FrameBlocks> frame_blocks(const ExrImage& frame, ErrorRegion region);

/// Returns the root mean square, over blocks and successive frames, of the change of block means that is not
/// in the scene. With the changes dx, da, db of a tested sequence x and of two reference sequences a and b,
/// it is the root of the mean of (dx - da)(dx - db) / (t^2 + 0.01 m^2). t is the mean of both references in
/// both frames, and m the mean of t. The sequences have different seeds, so that the noise of the references
/// does not count. Counts the blocks that have more than half of their pixels in the region in both frames of
/// both references. 0 if noise makes the mean negative. NaN without blocks, for fewer than two frames, and
/// when the sequences differ in length or size.
double flicker(const std::vector<FrameBlocks>& x, const std::vector<FrameBlocks>& a,
               const std::vector<FrameBlocks>& b);

/// Computes the same from picture files, one per frame. NaN when one of them cannot be read.
double flicker_of_files(const std::vector<std::filesystem::path>& x,
                        const std::vector<std::filesystem::path>& a,
                        const std::vector<std::filesystem::path>& b, ErrorRegion region);

}  // namespace pelage
