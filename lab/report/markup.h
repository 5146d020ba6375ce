// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>
#include <string_view>

namespace pelage {

/// Escapes text for HTML and SVG; the result may also be used in quoted attributes. Replaces bytes that are
/// not valid UTF-8, and characters that XML forbids.
std::string escape_markup(std::string_view text);

}  // namespace pelage
