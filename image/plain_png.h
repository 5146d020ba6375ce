// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>
#include <optional>
#include <string>

#include "image/image_sink.h"

namespace pelage {

/// Passes the image of a plain PNG file to `sink`: grey, grey and alpha, RGB or RGBA, with 8 or 16 bits per
/// channel, not interlaced, without palette and transparent colour. The texels are those that ImageReader
/// reads: alpha is not multiplied in, and gamma is ignored. Reading takes milliseconds, whereas loading the
/// module of ImageReader takes 0.2 s.
///
/// Returns an empty string on success, and a description of the problem when the file is damaged. Returns
/// nothing when the file is not such a PNG: nothing was passed to `sink`, and ImageReader should read it.
/// Exceptions of the sink propagate.
std::optional<std::string> read_plain_png(const std::filesystem::path& file, ImageSink& sink);

}  // namespace pelage
