// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>
#include <optional>

#include "image/exr.h"

namespace pelage {

/// The pixels over which errors are averaged, taken from the first reference.
enum class ErrorRegion {
  kSurfaces,  ///< alpha is not 0
  kFur,       ///< the layer `tangent` is not 0
};

/// Error of a picture x relative to two reference pictures a and b with other seeds. The noise of the
/// references is not counted, because (x - a)(x - b) is zero on average where x is right.
struct PictureError {
  double coverage = 0;      ///< mean alpha
  double region_share = 0;  ///< fraction of pixels in the region
  /// relMSE: mean over the pixels of the region and R, G, B of (x - a)(x - b) / (t^2 + 0.01 m^2). Here t is
  /// the mean of (a + b) / 2 over 9 x 9 pixels and m the mean of t over the region. The value of a
  /// single pixel instead of t would be small where a and b both happen to be too dark, and at these pixels
  /// errors are not zero on average. NaN without any pixel.
  double rel_mse = 0;
  /// Standard error of rel_mse, from squares of 16 x 16 pixels; NaN for fewer than two squares.
  double rel_mse_deviation = 0;
  /// The same of the means of 4 x 4 pixels more than half of which are in the region, with t over 3 x 3 of
  /// these means.
  double block_rel_mse = 0;
  double bias = 0;     ///< mean luminance of x over the region, relative to that of (a + b) / 2, minus 1
  double samples = 0;  ///< mean of the layer `samples` over all pixels; NaN without it
  double region_samples = 0;  ///< over the region
};

/// Empty when the pictures differ in size or lack R, G, B or A, or `a` lacks the layer of the region.
std::optional<PictureError> picture_error(const ExrImage& x, const ExrImage& a, const ExrImage& b,
                                          ErrorRegion region);

/// The same with two tested pictures x and y of other seeds, (x - a)(y - b) in place of (x - a)(x - b): the
/// noise of x and y is not counted either, only the error that both pictures share.
std::optional<PictureError> picture_error(const ExrImage& x, const ExrImage& y, const ExrImage& a,
                                          const ExrImage& b, ErrorRegion region);

/// The same for files; also empty when one of them cannot be read.
std::optional<PictureError> picture_error_of_files(const std::filesystem::path& x,
                                                   const std::filesystem::path& a,
                                                   const std::filesystem::path& b, ErrorRegion region);
std::optional<PictureError> picture_error_of_files(const std::filesystem::path& x,
                                                   const std::filesystem::path& y,
                                                   const std::filesystem::path& a,
                                                   const std::filesystem::path& b, ErrorRegion region);

/// Upper bound of the factor by which per-pixel sample counts can reduce the number of samples at equal
/// relMSE.
struct BestGain {
  double surface = 0;  ///< on pixels with alpha
  double all = 0;      ///< over all pixels, if pixels without alpha cost nothing
};
/// Computed from the variance of every pixel in the layers `samples` and `noise`: mean(v) / mean(sqrt(v))^2
/// over pixels with alpha, v the variance of a sample's luminance over t^2 + 0.01 m^2 [Neyman34]. Slightly
/// too large, because v is an estimate. NaN without the layers.
BestGain best_gain(const ExrImage& picture);

}  // namespace pelage
