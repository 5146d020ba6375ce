// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>

namespace pelage {

/// Walks the headers of an EXR file and refuses what would make a reader allocate more than the file can
/// account for: attributes longer than the file or not as long as they claim, pictures beyond 65536 pixels a
/// side, blocks of rows beyond half a GiB. OpenEXR itself believes those numbers. Throws Error (kInput)
/// naming the file.
void check_exr_headers(const std::filesystem::path& path);

}  // namespace pelage
