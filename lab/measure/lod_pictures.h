// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cmath>
#include <filesystem>
#include <optional>
#include <vector>

#include "lab/report/report.h"

namespace pelage {

/// Difference in luminance between two pictures with the same camera and seed. Relative to the mean luminance
/// of the pixels whose alpha is not 0.
struct PictureChange {
  double largest = NAN, rms = NAN;  ///< max and root mean square over these pixels
  /// Max over blocks of kChangeBlock^2 pixels of the mean difference, which averages out noise.
  double largest_block = NAN;
};
constexpr int kChangeBlock = 8;
/// Compares two picture files. All members are NaN when one of them cannot be read.
PictureChange change_between(const std::filesystem::path& from, const std::filesystem::path& to);

/// Combines pictures of equal size in a sheet with `columns` pictures per row. Each picture is reduced by an
/// integer factor until it is at most `max_width` wide. Empty when a picture cannot be read or has another
/// size.
std::optional<Picture> picture_sheet(const std::vector<std::filesystem::path>& files, size_t columns,
                                     int max_width, const std::string& caption);

/// Returns the layer `lod` of a picture in the colours of tools/exr_to_png: blue where every strand is kept,
/// red where one strand in a hundred is kept, black where there is no surface. Empty when the picture does
/// not have the layer.
std::optional<Picture> detail_picture(const std::filesystem::path& file);

}  // namespace pelage
