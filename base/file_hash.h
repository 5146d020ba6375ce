// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>

#include "base/hash.h"

namespace pelage {

/// Returns the content_hash() of all bytes of a file. Reads 256 KiB at a time, so the memory use does not
/// depend on the size of the file. Throws Error (kInput) when the file cannot be read or is not a regular
/// file.
ContentHash file_hash(const std::filesystem::path& path);

}  // namespace pelage
