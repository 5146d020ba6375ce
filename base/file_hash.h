// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>

#include "base/hash.h"

namespace pelage {

/// content_hash() of all bytes of a file, read piecewise: neither the heap nor the resident set grows with
/// the file. Throws Error (kInput) when it cannot be read or is not a regular file.
ContentHash file_hash(const std::filesystem::path& path);

}  // namespace pelage
