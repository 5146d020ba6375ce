// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <filesystem>
#include <optional>

#include "image/exr.h"
#include "lab/report/report.h"

namespace pelage {

/// Difference of two pictures of the same scene.
struct PictureDifference {
  int64_t pixels = 0;     ///< number of pixels of the picture
  int64_t differing = 0;  ///< pixels where any channel differs in any bit
  double largest = 0;     ///< max difference of red, green or blue
  Picture mask;           ///< white where the pictures differ
};

/// Empty unless both have the same size and channels.
std::optional<PictureDifference> compare_pictures(const ExrImage& a, const ExrImage& b);

/// The same for files; also empty when one of them cannot be read.
std::optional<PictureDifference> compare_picture_files(const std::filesystem::path& a,
                                                       const std::filesystem::path& b);

/// R, G and B for a screen (sRGB, clipped), reduced by an integer factor until it is at most `max_width`
/// wide. Empty without these channels.
std::optional<Picture> screen_picture(const ExrImage& image, int max_width, const std::string& caption);
std::optional<Picture> screen_picture_of(const std::filesystem::path& path, int max_width,
                                         const std::string& caption);

}  // namespace pelage
