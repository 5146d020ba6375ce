// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>
#include <string_view>

#include "lab/report/report.h"

namespace pelage {

/// A picture as a PNG file, by libpng.
std::string png_bytes(const Picture& picture);

/// Base 64 with padding [RFC 4648, section 4].
std::string base64(std::string_view bytes);

}  // namespace pelage
