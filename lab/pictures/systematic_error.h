// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cmath>
#include <filesystem>
#include <optional>

#include "image/exr.h"
#include "lab/pictures/error_region.h"

namespace pelage {

/// Error of block means that two pictures x and y of one variant with different seeds share. Relative to the
/// mean t of two references a and b; all four pictures have different seeds, so that no noise counts. Counts
/// the blocks that have more than half of their pixels in the region.
struct BlockError {
  /// Root of the mean of (x - a)(y - b) / (t^2 + 0.01 m^2) over blocks and R, G and B; m is the mean of t
  /// over both. 0 if noise makes this mean negative. NaN without blocks.
  double rms = NAN;
  /// Signed error of the worst block, from sums s over R, G and B: the error s(x - a) / sqrt(s(t)^2 + 0.01
  /// s(m)^2) of the block where the error of y is largest, or the error of y where the error of x is largest;
  /// the larger of the two. The largest error of many blocks would be large by noise alone. The noise of the
  /// other picture is independent of the choice.
  double worst = NAN;
};

struct SystematicError {
  BlockError of_8;   ///< blocks of 8 x 8 pixels
  BlockError of_32;  ///< blocks of 32 x 32 pixels
};

/// Empty when the pictures differ in size or lack R, G or B, or when `a` or `b` lacks the layer of the
/// region.
std::optional<SystematicError> systematic_error(const ExrImage& x, const ExrImage& y, const ExrImage& a,
                                                const ExrImage& b, ErrorRegion region);

/// Compares picture files in the same way. Also empty when one of them cannot be read.
std::optional<SystematicError> systematic_error_of_files(const std::filesystem::path& x,
                                                         const std::filesystem::path& y,
                                                         const std::filesystem::path& a,
                                                         const std::filesystem::path& b, ErrorRegion region);

}  // namespace pelage
