// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <filesystem>
#include <optional>

#include "image/exr.h"
#include "lab/report/report.h"

namespace pelage {

/// Difference between two pictures of the same scene.
struct PictureDifference {
  int64_t pixels = 0;     ///< number of pixels of each picture
  int64_t differing = 0;  ///< number of pixels where any bit of any channel differs
  double largest = 0;     ///< max absolute difference over all pixels, in R, G or B
  Picture mask;           ///< white where the pictures differ, else black
};

/// Compares two pictures. Empty unless they have the same size and the same channels.
std::optional<PictureDifference> compare_pictures(const ExrImage& a, const ExrImage& b);

/// Compares two picture files. Also empty when one of them cannot be read.
std::optional<PictureDifference> compare_picture_files(const std::filesystem::path& a,
                                                       const std::filesystem::path& b);

/// Converts R, G and B for a screen: sRGB, clipped. Reduces the picture by an integer factor so that it is at
/// most `max_width` wide. Empty when one of these channels is missing.
std::optional<Picture> screen_picture(const ExrImage& image, int max_width, const std::string& caption);
/// Reads a picture file and converts it. Also empty when it cannot be read.
std::optional<Picture> screen_picture_of(const std::filesystem::path& path, int max_width,
                                         const std::string& caption);

}  // namespace pelage
