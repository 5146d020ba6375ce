// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>

#include "base/error.h"
#include "base/value_readers.h"

namespace pelage {

/// Throws Error (kInput) at the position in the scene that names the file. The message is the path, followed
/// by `reason`.
[[noreturn]] void fail_image(const AssetPath& asset, const std::string& reason);

/// Throws Error (kInput) with a clear message for problems that image libraries report poorly: a file that is
/// missing, empty, truncated (PNG and JPEG), not a regular file or a git-lfs pointer, or damaged EXR headers.
void check_image_file(const AssetPath& asset);

}  // namespace pelage
