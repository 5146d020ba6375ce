// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>

#include "base/error.h"
#include "base/value_readers.h"

namespace pelage {

/// An Error (kInput) at the place in the scene that names a file, which the message begins with.
[[noreturn]] void fail_image(const AssetPath& asset, const std::string& reason);

/// Throws what no image library says clearly: a missing, empty or truncated file, damaged EXR headers.
void check_image_file(const AssetPath& asset);

}  // namespace pelage
