// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <filesystem>
#include <optional>

#include "image/exr.h"
#include "lab/report/report.h"

namespace pelage {

/// How two pictures of the same scene differ.
struct PictureDifference {
  int64_t pixels = 0;     ///< of the picture
  int64_t differing = 0;  ///< pixels of which any channel has other bits
  double largest = 0;     ///< difference of red, green or blue
  Picture mask;           ///< white where they differ
};

/// Nothing when the two do not have the same size and channels.
std::optional<PictureDifference> compare_pictures(const ExrImage& a, const ExrImage& b);

/// The same for files; nothing also when one of them cannot be read.
std::optional<PictureDifference> compare_picture_files(const std::filesystem::path& a,
                                                       const std::filesystem::path& b);

/// R, G and B for a screen (sRGB, clipped), made smaller by whole factors until it is at most `max_width`
/// wide. Nothing without these channels.
std::optional<Picture> screen_picture(const ExrImage& image, int max_width, const std::string& caption);
std::optional<Picture> screen_picture_of(const std::filesystem::path& path, int max_width,
                                         const std::string& caption);

}  // namespace pelage
