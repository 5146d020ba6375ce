// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cmath>
#include <filesystem>
#include <optional>
#include <vector>

#include "lab/report/report.h"

namespace pelage {

/// Difference in luminance between two pictures with the same camera and seed, relative to the mean luminance
/// of the pixels with alpha.
struct PictureChange {
  double largest = NAN, rms = NAN;  ///< over pixels
  double largest_block = NAN;       ///< over means of kChangeBlock^2 pixels, which average out noise
};
constexpr int kChangeBlock = 8;
/// NaN when a file cannot be read.
PictureChange change_between(const std::filesystem::path& from, const std::filesystem::path& to);

/// Combines pictures of equal size, `columns` per row, each reduced until it is at most `max_width` wide.
/// Empty when one is missing or has another size.
std::optional<Picture> picture_sheet(const std::vector<std::filesystem::path>& files, size_t columns,
                                     int max_width, const std::string& caption);

/// The layer `lod` in the colours of tools/exr_to_png: from blue (every strand) to red (one in a hundred);
/// black where there is nothing. Empty without the layer.
std::optional<Picture> detail_picture(const std::filesystem::path& file);

}  // namespace pelage
