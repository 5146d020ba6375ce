// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>

namespace pelage {

/// Reads the headers of an EXR file and rejects values that OpenEXR would trust, although a reader would then
/// allocate far more memory than the contents of the file need: attributes longer than the file or of the
/// wrong length, pictures of more than 65536 pixels per side, and blocks of jointly compressed rows above 512
/// MiB (or above 64 MiB and 4096 times the size of the file). Throws Error (kInput) naming the file.
void check_exr_headers(const std::filesystem::path& path);

}  // namespace pelage
