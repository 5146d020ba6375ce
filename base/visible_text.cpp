// SPDX-License-Identifier: Apache-2.0
#include "base/visible_text.h"

#include <cstddef>

#include <fmt/format.h>

namespace pelage {

std::string visible(std::string_view text) {
  std::string result;
  size_t rest = 0;  // bytes that may still belong to the current UTF-8 sequence
  for (size_t i = 0; i < text.size(); ++i) {
    const auto byte = static_cast<unsigned char>(text[i]);
    const auto next = i + 1 < text.size() ? static_cast<unsigned char>(text[i + 1]) : 0;
    const bool continues = rest > 0 && byte >= 0x80 && byte < 0xc0;
    rest = continues ? rest - 1 : byte >= 0xf0 ? 3 : byte >= 0xe0 ? 2 : byte >= 0xc2 ? 1 : 0;
    const bool ascii = (byte < 0x20 && byte != '\n' && byte != '\t') || byte == 0x7f;
    // Terminals also obey U+0080 to U+009F, as UTF-8 or as single bytes.
    const bool wide =
        !continues && ((byte >= 0x80 && byte < 0xa0) || (byte == 0xc2 && next >= 0x80 && next < 0xa0));
    if (ascii || wide) {
      result += fmt::format("\\x{:02x}", byte);
      rest = 0;
    } else {
      result += text[i];
    }
  }
  return result;
}

}  // namespace pelage
