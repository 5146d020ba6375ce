// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>

namespace pelage {

/// Writes a small PNG of an EXR picture, at most `width` pixels wide, as a screen shows it. Each pixel is the
/// mean of the pixels that it covers. Reads a few rows at a time. Throws Error: kInput if the picture cannot
/// be read or has no channels R, G and B, kFailed if the PNG cannot be written.
void write_thumbnail(const std::filesystem::path& picture, const std::filesystem::path& png, int width);

}  // namespace pelage
