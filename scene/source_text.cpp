// SPDX-License-Identifier: Apache-2.0
#include "scene/source_text.h"

#include <algorithm>

namespace pelage {
namespace {

constexpr int kMaxBrackets = 256;

bool is_continuation(char c) { return (static_cast<unsigned char>(c) & 0xc0) == 0x80; }

// Length of the well-formed UTF-8 sequence at the start of `text`, or 0.
size_t sequence_length(std::string_view text) {
  const auto lead = static_cast<unsigned char>(text[0]);
  if (lead < 0x80) return 1;
  const size_t length = lead >= 0xc2 && lead <= 0xdf   ? 2
                        : lead >= 0xe0 && lead <= 0xef ? 3
                        : lead >= 0xf0 && lead <= 0xf4 ? 4
                                                       : 0;
  if (length == 0 || text.size() < length) return 0;
  if (!std::all_of(text.begin() + 1, text.begin() + static_cast<std::ptrdiff_t>(length), is_continuation))
    return 0;
  // Overlong forms, surrogates and code points beyond U+10FFFF are visible in the second byte.
  const auto second = static_cast<unsigned char>(text[1]);
  if ((lead == 0xe0 && second < 0xa0) || (lead == 0xed && second > 0x9f)) return 0;
  if ((lead == 0xf0 && second < 0x90) || (lead == 0xf4 && second > 0x8f)) return 0;
  return length;
}

bool is_forbidden_control(std::string_view text) {
  const auto c = static_cast<unsigned char>(text[0]);
  if (c == '\r') return text.size() < 2 || text[1] != '\n';
  return (c < 0x20 && c != '\n' && c != '\t') || c == 0x7f;
}

}  // namespace

SourceText::SourceText(std::string text, std::string file) : text_(std::move(text)), file_(std::move(file)) {
  if (text_.starts_with("\xef\xbb\xbf")) text_.erase(0, 3);
  line_starts_.push_back(0);
  for (size_t i = 0; i < text_.size(); ++i) {
    if (text_[i] == '\n') line_starts_.push_back(i + 1);
  }
}

std::string_view SourceText::line(int line) const {
  if (line < 0 || static_cast<size_t>(line) >= line_starts_.size()) return {};
  const std::string_view rest = std::string_view(text_).substr(line_starts_[static_cast<size_t>(line)]);
  return rest.substr(0, rest.find('\n'));
}

SourcePosition SourceText::position(int line, int byte_column) {
  line = std::clamp(line, 0, static_cast<int>(line_starts_.size()) - 1);
  const size_t start = line_starts_[static_cast<size_t>(line)];
  const size_t wanted = std::min(static_cast<size_t>(std::max(byte_column, 0)), text_.size() - start);
  if (line != counted_line_ || wanted < counted_bytes_) {
    counted_line_ = line;
    counted_bytes_ = 0;
    counted_characters_ = 0;
  }
  for (; counted_bytes_ < wanted; ++counted_bytes_) {
    counted_characters_ += is_continuation(text_[start + counted_bytes_]) ? 0 : 1;
  }
  return {file_, line + 1, counted_characters_ + 1};
}

std::optional<Problem> SourceText::mistake() {
  int brackets = 0;  // open ones; counting those in comments and quotes too is harmless at this size
  for (size_t i = 0; i < text_.size();) {
    const std::string_view rest = std::string_view(text_).substr(i);
    const size_t length = sequence_length(rest);
    if (text_[i] == '[' || text_[i] == '{') ++brackets;
    if (text_[i] == ']' || text_[i] == '}') brackets = std::max(brackets - 1, 0);
    const char* mistake = length == 0                  ? "the text is not UTF-8"
                          : is_forbidden_control(rest) ? "a scene must not contain control characters"
                          : brackets > kMaxBrackets    ? "too many open brackets"
                                                       : nullptr;
    if (mistake) return Problem{position_of_byte(i), mistake};
    i += length;
  }
  return {};
}

SourcePosition SourceText::position_of_byte(size_t byte) {
  const auto after = std::upper_bound(line_starts_.begin(), line_starts_.end(), byte);
  const auto line = static_cast<size_t>(after - line_starts_.begin()) - 1;
  return position(static_cast<int>(line), static_cast<int>(byte - line_starts_[line]));
}

}  // namespace pelage
