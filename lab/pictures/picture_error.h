// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>
#include <optional>

#include "image/exr.h"

namespace pelage {

/// How far a picture is from the truth, of which there are two pictures of independent seeds: the noise of
/// neither is counted, because (x - a)(x - b) is zero on average where x is right.
struct PictureError {
  double coverage = 0;       ///< mean alpha
  double surface_share = 0;  ///< pixels with any alpha in `a`, over all
  double rel_mse = 0;  ///< over pixels with alpha: mean of (x - a)(x - b) / (t^2 + 0.01 m^2) over channels,
                       ///< t = (a + b) / 2 and m the mean of t over these pixels
  double bias = 0;     ///< mean luminance over these pixels, of x over that of t, - 1
  double samples = 0;  ///< mean of the layer `samples` over all pixels; not-a-number without it
  double surface_samples = 0;  ///< over pixels with alpha
};

/// Nothing when the pictures differ in size or lack R, G, B or A.
std::optional<PictureError> picture_error(const ExrImage& x, const ExrImage& a, const ExrImage& b);

/// The same where there are two pictures of independent seeds of what is tested too: then their noise is not
/// counted either, only what is wrong in both. Here t is the mean over 9 x 9 pixels around each: that of a
/// pixel alone is small where a and b both happen to be too dark, and errors there are not zero on average.
std::optional<PictureError> picture_error(const ExrImage& x, const ExrImage& y, const ExrImage& a,
                                          const ExrImage& b);

/// The same for files; nothing also when one of them cannot be read.
std::optional<PictureError> picture_error_of_files(const std::filesystem::path& x,
                                                   const std::filesystem::path& a,
                                                   const std::filesystem::path& b);
std::optional<PictureError> picture_error_of_files(const std::filesystem::path& x,
                                                   const std::filesystem::path& y,
                                                   const std::filesystem::path& a,
                                                   const std::filesystem::path& b);

/// How many times fewer samples than plain sampling any counts by pixel can take for the same relMSE.
struct BestGain {
  double surface = 0;  ///< on pixels with alpha
  double all = 0;      ///< in all, were other pixels free
};
/// From the variance of every pixel, as a picture with the layers `samples` and `noise` knows it: mean(v) /
/// mean(sqrt(v))^2 over pixels with alpha, v the variance of a sample of the luminance over t^2 + 0.01 m^2
/// [Neyman34]. As v is an estimate, this is a little too much. NaN where layers are missing.
BestGain best_gain(const ExrImage& picture);

}  // namespace pelage
