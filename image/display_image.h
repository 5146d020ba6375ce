// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <filesystem>
#include <vector>

#include "base/file.h"

namespace pelage {

/// A picture for a screen: 8 bits per channel, rows from the top, the channels R, G, B of a pixel adjacent.
struct DisplayImage {
  int width = 0;
  int height = 0;
  std::vector<uint8_t> pixels;  ///< width * height * 3 values
};

/// Returns whether write_display_image() knows the format that the extension of a file name states: .png,
/// .jpg or .jpeg, in any case.
bool is_display_image(const std::filesystem::path& path);

/// Writes a picture through the module of image/reader_module.h, in the format that the extension of `path`
/// states. The file appears completely or not at all (law 6). Throws Error (kFailed) naming the path.
void write_display_image(const std::filesystem::path& path, const DisplayImage& image,
                         Links links = Links::kFollow);

}  // namespace pelage
