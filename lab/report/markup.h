// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>
#include <string_view>

namespace pelage {

/// Text for HTML and SVG, also inside quoted attributes: markup escaped, and bytes that XML forbids or that
/// are not UTF-8 replaced.
std::string escape_markup(std::string_view text);

}  // namespace pelage
