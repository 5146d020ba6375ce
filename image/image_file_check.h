// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>

#include "base/error.h"
#include "base/value_readers.h"

namespace pelage {

/// Throws an Error (kInput) at the place in the scene that names a file; the message starts with the file
/// name.
[[noreturn]] void fail_image(const AssetPath& asset, const std::string& reason);

/// Throws clear errors for problems that image libraries report poorly: a missing, empty or truncated file,
/// damaged EXR headers.
void check_image_file(const AssetPath& asset);

}  // namespace pelage
