// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cmath>
#include <filesystem>
#include <optional>
#include <vector>

#include "lab/report/report.h"

namespace pelage {

/// How much two pictures of one camera and one seed differ: of the luminance, relative to its mean over
/// pixels with alpha.
struct PictureChange {
  double largest = NAN, rms = NAN;  ///< of pixels
  double largest_block = NAN;       ///< of means over kChangeBlock^2 pixels: what is more than noise
};
constexpr int kChangeBlock = 8;
/// Not-a-number when a file cannot be read.
PictureChange change_between(const std::filesystem::path& from, const std::filesystem::path& to);

/// Pictures of equal size as one, `columns` beside each other, each made smaller until it is at most
/// `max_width` wide. Nothing when one is missing or of another size.
std::optional<Picture> picture_sheet(const std::vector<std::filesystem::path>& files, size_t columns,
                                     int max_width, const std::string& caption);

/// The layer `lod` in the colours of tools/exr_to_png: from blue, every strand, to red, a hundredth of them;
/// black where there is nothing. Nothing without the layer.
std::optional<Picture> detail_picture(const std::filesystem::path& file);

}  // namespace pelage
