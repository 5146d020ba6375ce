// SPDX-License-Identifier: Apache-2.0
#include "rib/syntax/rib_lexer.h"

#include <algorithm>
#include <bit>
#include <cctype>
#include <charconv>
#include <cmath>

#include <fmt/format.h>

#include "base/nearest_name.h"

namespace pelage {
namespace {

// 0x1a ends text files of DOS.
bool is_blank(int c) {
  return c == ' ' || c == 0x1a || c == '\t' || c == '\n' || c == '\r' || c == '\f' || c == '\v';
}
bool is_letter(int c) { return (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z') || c == '_'; }
bool is_digit(int c) { return c >= '0' && c <= '9'; }
bool starts_number(int c) { return is_digit(c) || c == '-' || c == '+' || c == '.'; }
// Letters are part of a number too, so that "1x" is one wrong number and not a number and a request.
bool continues_number(int c) { return starts_number(c) || is_letter(c); }

/// "nan", "inf" and the like, as C libraries print numbers that are not finite.
bool is_not_finite(std::string word) {
  for (char& c : word) c = static_cast<char>(std::tolower(static_cast<unsigned char>(c)));
  return word.starts_with("nan") || word == "inf" || word == "infinity";
}

uint32_t big_endian(const uint8_t* b) {
  return uint32_t(b[0]) << 24 | uint32_t(b[1]) << 16 | uint32_t(b[2]) << 8 | uint32_t(b[3]);
}

}  // namespace

void RibLexer::fail(const std::string& why) const { throw Error(ErrorKind::kInput, position(), why); }

void RibLexer::skip_blanks() {
  for (;;) {
    const int c = bytes_.peek();
    if (c == '#') {
      for (int d = bytes_.peek(); d != '\n' && d != RibBytes::kEnd; d = bytes_.peek()) bytes_.take();
    } else if (is_blank(c)) {
      bytes_.take();
    } else {
      return;
    }
  }
}

RibToken RibLexer::next() {
  for (;;) {
    skip_blanks();
    line_ = bytes_.line();
    column_ = bytes_.column();
    const int first = bytes_.peek();
    if (first == RibBytes::kEnd) return RibToken::kEnd;
    if (first < 0x80) return read_text(first);
    if (first == 0xef && line_ == 1 && column_ == 1) {  // a byte-order mark, which is no code of RIB
      for (int i = 0; i < 3; ++i) bytes_.take();
      continue;
    }
    // Definitions of codes are not tokens.
    if (first < 0xcc || first > 0xce) return read_binary();
    bytes_.take();
    define_string(first == 0xcc ? 0 : first - 0xcd + 1);
  }
}

RibToken RibLexer::read_text(int first) {
  if (is_letter(first)) return read_word();
  if (starts_number(first)) return read_number();
  bytes_.take();
  if (first == '[') return RibToken::kOpen;
  if (first == ']') return RibToken::kClose;
  if (first == '"') {
    read_quoted();
    return RibToken::kString;
  }
  const bool shown = first > 0x20 && first < 0x7f;
  fail(shown ? fmt::format("expected a request, a value or a parameter, got '{}'", static_cast<char>(first))
             : fmt::format("expected a request, a value or a parameter, got a byte {}", first));
}

RibToken RibLexer::read_word() {
  text_.clear();
  for (int c = bytes_.peek(); is_letter(c) || is_digit(c); c = bytes_.peek()) {
    if (text_.size() >= 256) fail("the name of a request has more than 256 letters");
    text_ += static_cast<char>(bytes_.take());
  }
  if (is_not_finite(text_)) fail(quote(text_) + " is not a number");
  return RibToken::kRequest;
}

RibToken RibLexer::read_number() {
  char digits[128];
  size_t length = 0;
  for (int c = bytes_.peek(); continues_number(c); c = bytes_.peek()) {
    if (length == sizeof digits) fail("a number has more than 128 characters");
    digits[length++] = static_cast<char>(bytes_.take());
  }
  // "1.#QNAN" and "-1.#IND" of Windows would otherwise be 1 and a comment that hides the rest of the line.
  if (length > 1 && digits[length - 1] == '.' && bytes_.peek() == '#') {
    bytes_.take();
    std::string word;
    while (is_letter(bytes_.peek()) && word.size() < 4) word += static_cast<char>(bytes_.take());
    if (word == "QNAN" || word == "SNAN" || word == "IND" || word == "INF")
      fail(quote(std::string(digits, length) + "#" + word) + " is not a number");
    while (bytes_.peek() != '\n' && bytes_.peek() != RibBytes::kEnd) bytes_.take();
  }
  const char* begin = digits;
  const char* end = digits + length;
  const bool plus = *begin == '+' && length > 1 && begin[1] != '-';
  begin += plus ? 1 : 0;
  if (auto [stop, error] = std::from_chars(begin, end, integer_); error == std::errc() && stop == end)
    return RibToken::kInteger;
  auto [stop, error] = std::from_chars(begin, end, number_);
  if (stop != end || (error != std::errc() && error != std::errc::result_out_of_range) ||
      is_letter(begin[*begin == '-' ? 1 : 0]))
    fail(quote({digits, length}) + " is not a number");
  if (error != std::errc()) {
    // With at most 128 characters, only the exponent can make a number too large or too small.
    const size_t exponent = std::string_view(begin, end).find_first_of("eE");
    if (begin[exponent + 1] != '-') fail(quote({digits, length}) + " is too large for a number");
    number_ = 0;
  }
  return RibToken::kFloat;
}

void RibLexer::read_quoted() {
  text_.clear();
  for (;;) {
    int c = bytes_.take();
    if (c == RibBytes::kEnd) fail("a string has no closing quote");
    if (c == '"') return;
    if (c == '\\') c = read_escape();
    if (c == 256) continue;
    if (text_.size() >= kMaxRibString) fail("a string has more than 16 MiB");
    text_ += static_cast<char>(c);
  }
}

// Returns 256 for a continued line, which adds no character.
int RibLexer::read_escape() {
  const int c = bytes_.take();
  switch (c) {
    case 'n':
      return '\n';
    case 'r':
      return '\r';
    case 't':
      return '\t';
    case 'b':
      return '\b';
    case 'f':
      return '\f';
    case '\n':
      return 256;
    case RibBytes::kEnd:
      fail("a string has no closing quote");
    default:
      break;
  }
  if (c < '0' || c > '7') return c;
  int value = c - '0';
  for (int digit = 1; digit < 3 && bytes_.peek() >= '0' && bytes_.peek() <= '7'; ++digit)
    value = 8 * value + (bytes_.take() - '0');
  return value & 0xff;
}

uint64_t RibLexer::unsigned_operand(int bytes) {
  uint8_t raw[4] = {};
  bytes_.take_binary(raw, static_cast<size_t>(bytes), "a binary number");
  uint64_t value = 0;
  for (int i = 0; i < bytes; ++i) value = value << 8 | raw[i];
  return value;
}

RibToken RibLexer::read_binary() {
  const int code = bytes_.take();
  if (code <= 0x8f) return read_binary_integer(code - 0x80);
  if (code <= 0x9f) return read_binary_string(static_cast<uint64_t>(code - 0x90));
  if (code <= 0xa3) return read_binary_string(unsigned_operand(code - 0xa0 + 1));
  if (code == 0xa4) {
    number_ = std::bit_cast<float>(static_cast<uint32_t>(unsigned_operand(4)));
    return RibToken::kFloat;
  }
  if (code == 0xa5) {
    const uint64_t high = unsigned_operand(4);
    number_ = std::bit_cast<double>(high << 32 | unsigned_operand(4));
    return RibToken::kFloat;
  }
  const auto defined = [&](const std::map<uint64_t, std::string>& table, uint64_t key, const char* what) {
    const auto found = table.find(key);
    if (found == table.end()) fail(fmt::format("the file uses {} {} before it defines it", what, key));
    text_ = found->second;
  };
  if (code == 0xa6) {
    defined(requests_, unsigned_operand(1), "request code");
    return RibToken::kRequest;
  }
  if (code >= 0xc8 && code <= 0xcb) return read_binary_floats(code - 0xc8 + 1);
  if (code == 0xcf || code == 0xd0) {
    defined(strings_, unsigned_operand(code - 0xcf + 1), "string code");
    return RibToken::kString;
  }
  fail(fmt::format("byte {} has no meaning in a RIB file", code));
}

// Integers, and fixed-point numbers with `fraction` bytes after the point.
RibToken RibLexer::read_binary_integer(int code) {
  const int fraction = code / 4, width = code % 4 + 1;
  const uint64_t raw = unsigned_operand(width);
  const int unused = 64 - 8 * width;
  integer_ = static_cast<int64_t>(raw << unused) >> unused;
  if (fraction == 0) return RibToken::kInteger;
  number_ = std::ldexp(static_cast<double>(integer_), -8 * fraction);
  return RibToken::kFloat;
}

RibToken RibLexer::read_binary_string(uint64_t length) {
  if (length > kMaxRibString) fail(fmt::format("a string claims {} bytes; the limit is 16 MiB", length));
  text_.clear();
  // In blocks, because a damaged file may claim more than it has.
  constexpr uint64_t kBlock = 4096;
  while (text_.size() < length) {
    const size_t before = text_.size(), some = std::min<uint64_t>(kBlock, length - before);
    text_.resize(before + some);
    bytes_.take_binary(&text_[before], some, "a string");
  }
  return RibToken::kString;
}

RibToken RibLexer::read_binary_floats(int length_bytes) {
  const uint64_t count = unsigned_operand(length_bytes);
  if (count > kMaxRibCount)
    fail(fmt::format("an array claims {} numbers; the limit is {}", count, kMaxRibCount));
  floats_.clear();
  constexpr size_t kBlock = 4096;
  uint8_t raw[4 * kBlock];
  while (floats_.size() < count) {
    const size_t before = floats_.size(), some = std::min<uint64_t>(kBlock, count - before);
    if (grows_) grows_(4 * some);
    bytes_.take_binary(raw, 4 * some, "an array");
    floats_.resize(before + some);
    for (size_t i = 0; i < some; ++i) floats_[before + i] = std::bit_cast<float>(big_endian(raw + 4 * i));
  }
  return RibToken::kFloats;
}

// 0 code bytes: the name of a request, which has a code of one byte.
void RibLexer::define_string(int code_bytes) {
  const uint64_t code = unsigned_operand(std::max(1, code_bytes));
  skip_blanks();
  const int first = bytes_.peek();
  if (first == '"') {
    read_text(first);
  } else if ((first >= 0x90 && first <= 0xa3) || first == 0xcf || first == 0xd0) {
    read_binary();
  } else {
    fail("expected the string that a code stands for");
  }
  // A definition may repeat an earlier one, so that a short file could define long strings without end.
  defined_bytes_ += text_.size();
  if (defined_bytes_ > kMaxRibDefinitions)
    fail(fmt::format("the strings defined for codes have more than {} bytes in total", kMaxRibDefinitions));
  (code_bytes == 0 ? requests_ : strings_)[code] = text_;
}

}  // namespace pelage
