// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>
#include <optional>

#include "image/exr.h"

namespace pelage {

/// Error of a picture relative to two reference pictures with independent seeds. The noise of the references
/// is not counted, because (x - a)(x - b) is zero on average where x is right.
struct PictureError {
  double coverage = 0;       ///< mean alpha
  double surface_share = 0;  ///< fraction of pixels with any alpha in `a`
  double rel_mse = 0;  ///< over pixels with alpha: mean of (x - a)(x - b) / (t^2 + 0.01 m^2) over channels,
                       ///< with t = (a + b) / 2 and m the mean of t over these pixels
  double bias = 0;     ///< mean luminance of x over these pixels, relative to the same mean of t, minus 1
  double samples = 0;  ///< mean of the layer `samples` over all pixels; NaN without it
  double surface_samples = 0;  ///< over pixels with alpha
};

/// Empty when the pictures differ in size or lack R, G, B or A.
std::optional<PictureError> picture_error(const ExrImage& x, const ExrImage& a, const ExrImage& b);

/// The same with two tested pictures x and y of independent seeds: the noise of x and y is not counted
/// either, only the error that both pictures share. Here t is the mean over the 9 x 9 pixels around each
/// pixel. The value of a single pixel would be small where a and b both happen to be too dark, and at these
/// pixels errors are not zero on average.
std::optional<PictureError> picture_error(const ExrImage& x, const ExrImage& y, const ExrImage& a,
                                          const ExrImage& b);

/// The same for files; also empty when one of them cannot be read.
std::optional<PictureError> picture_error_of_files(const std::filesystem::path& x,
                                                   const std::filesystem::path& a,
                                                   const std::filesystem::path& b);
std::optional<PictureError> picture_error_of_files(const std::filesystem::path& x,
                                                   const std::filesystem::path& y,
                                                   const std::filesystem::path& a,
                                                   const std::filesystem::path& b);

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
