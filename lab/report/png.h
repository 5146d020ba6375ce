// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>
#include <string_view>

#include "lab/report/report.h"

namespace pelage {

/// Returns a picture as the content of a PNG file, written by libpng.
std::string png_bytes(const Picture& picture);

/// Returns bytes in base 64 with padding [RFC 4648, section 4].
std::string base64(std::string_view bytes);

}  // namespace pelage
