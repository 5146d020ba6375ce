// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>
#include <optional>

#include "image/exr.h"
#include "lab/pictures/error_region.h"

namespace pelage {

/// Error of a picture x relative to two reference pictures a and b. The three pictures have different seeds.
/// The noise of the references does not count, because (x - a)(x - b) is zero on average where x is right.
struct PictureError {
  double coverage = 0;      ///< mean alpha of the first reference
  double region_share = 0;  ///< fraction of pixels in the region
  /// relMSE: the mean of (x - a)(x - b) / (t^2 + 0.01 m^2) over R, G and B of the pixels of the region. t is
  /// the mean of (a + b) / 2 over the 9 x 9 pixels around a pixel, and m the mean of t over the region. With
  /// the value of a single pixel instead of t, pixels where a and b both happen to be too dark would get a
  /// large weight, and the errors of these pixels are not zero on average. NaN if the region has no pixels.
  double rel_mse = 0;
  /// Standard error of rel_mse, computed from sums over squares of 16 x 16 pixels. NaN for fewer than two
  /// squares.
  double rel_mse_deviation = 0;
  /// relMSE of pictures that consist of means of blocks of 4 x 4 or 16 x 16 pixels. Counts the blocks that
  /// have more than half of their pixels in the region. Here, t is the mean of (a + b) / 2 over 3 x 3 blocks.
  double rel_mse_4 = 0, rel_mse_16 = 0;
  /// 99.9th percentile of the error of a pixel: the root of the term of rel_mse that only one pixel of the
  /// region in a thousand exceeds. The term is a mean over R, G and B.
  double top_error = 0;
  double bias = 0;     ///< mean luminance of x over the region, divided by that of (a + b) / 2, minus 1
  double samples = 0;  ///< mean of the layer `samples` over all pixels; NaN without this layer
  double region_samples = 0;  ///< mean of the layer `samples` over the region; NaN without this layer
};

/// Empty when the pictures differ in size or lack R, G, B or A, or `a` or `b` lacks the layer of the region.
std::optional<PictureError> picture_error(const ExrImage& x, const ExrImage& a, const ExrImage& b,
                                          ErrorRegion region);

/// Returns the error that two tested pictures x and y with different seeds share. In rel_mse, replaces
/// (x - a)(x - b) by the mean of (x - a)(y - b) and (x - b)(y - a), so that the noise of x and y does not
/// count either. `bias` is the bias of (x + y) / 2.
std::optional<PictureError> picture_error(const ExrImage& x, const ExrImage& y, const ExrImage& a,
                                          const ExrImage& b, ErrorRegion region);

/// Compares picture files in the same way. Also empty when one of them cannot be read.
std::optional<PictureError> picture_error_of_files(const std::filesystem::path& x,
                                                   const std::filesystem::path& a,
                                                   const std::filesystem::path& b, ErrorRegion region);
std::optional<PictureError> picture_error_of_files(const std::filesystem::path& x,
                                                   const std::filesystem::path& y,
                                                   const std::filesystem::path& a,
                                                   const std::filesystem::path& b, ErrorRegion region);

/// Upper bound of the gain of adaptive sampling: the factor by which different sample counts per pixel can
/// reduce the total number of samples at equal relMSE.
struct BestGain {
  double surface = 0;  ///< total over the pixels with alpha
  double all = 0;      ///< total over all pixels, if pixels without alpha cost nothing
};
/// Computes this bound from the layers `samples` and `noise` of a picture. Over pixels with alpha, it is
/// mean(v) / mean(sqrt(v))^2 [Neyman34]. Here v is the variance of the luminance of a pixel's samples,
/// divided by t^2 + 0.01 m^2, with the luminance t of the pixel and the mean m of t. The result is slightly
/// too large, because v is an estimate. NaN when a layer is missing.
BestGain best_gain(const ExrImage& picture);

}  // namespace pelage
