// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>
#include <optional>
#include <string>

#include "image/image_sink.h"

namespace pelage {

/// Passes the image of a Radiance file to `sink`, whatever the name of the file: 32-bit RGBE pixels, plain or
/// in either run-length encoding [Ward91], rows from the top, pixels from the left. The texels are those that
/// ImageReader reads: EXPOSURE and GAMMA are ignored. ImageReader reads no pixel runs, which old files have.
/// Reading takes milliseconds, whereas loading the module of ImageReader takes 0.2 s.
///
/// Returns an empty string on success, and a description of the problem when the file is damaged or has other
/// axes. Returns nothing when the file is not such a file: nothing was passed to `sink`, and ImageReader
/// should read it. Exceptions of the sink propagate.
std::optional<std::string> read_radiance_hdr(const std::filesystem::path& file, ImageSink& sink);

}  // namespace pelage
