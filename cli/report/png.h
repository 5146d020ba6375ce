// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>
#include <string_view>

#include "cli/report/report.h"

namespace pelage {

/// A picture as a PNG file [PNG]. Its pixels are stored, not compressed: pictures in reports are small, and
/// this needs no library.
std::string png_bytes(const Picture& picture);

/// Base 64 with padding [RFC 4648, section 4].
std::string base64(std::string_view bytes);

}  // namespace pelage
