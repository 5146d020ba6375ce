// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>

namespace pelage {

/// Reads the headers of an EXR file and rejects headers that would make a reader allocate more memory than
/// the file can contain: attributes that exceed the file or have inconsistent lengths, pictures beyond 65536
/// pixels per side, blocks of rows beyond half a GiB. OpenEXR itself trusts those numbers. Throws Error
/// (kInput) naming the file.
void check_exr_headers(const std::filesystem::path& path);

}  // namespace pelage
