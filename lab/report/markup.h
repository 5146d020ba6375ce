// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>
#include <string_view>

namespace pelage {

/// Escapes text for HTML and SVG, also inside quoted attributes; replaces bytes that XML forbids or that are
/// not UTF-8.
std::string escape_markup(std::string_view text);

}  // namespace pelage
