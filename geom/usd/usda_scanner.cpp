// SPDX-License-Identifier: Apache-2.0
#include "geom/usd/usda_scanner.h"

#include <algorithm>
#include <array>
#include <charconv>

#include "base/visible_text.h"

namespace pelage {
namespace {

constexpr size_t kMaxBrackets = 64;

bool is_name_start(char c) {
  return (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z') || c == '_' ||
         static_cast<unsigned char>(c) >= 0x80;
}
/// Which characters end a run that skip_brackets() need not look at.
constexpr auto kSpecial = [] {
  std::array<bool, 256> special{};
  for (const char c : std::string_view("[](){}\"'@#/")) special[static_cast<unsigned char>(c)] = true;
  return special;
}();

bool is_name_part(char c) { return is_name_start(c) || (c >= '0' && c <= '9'); }

}  // namespace

char UsdaScanner::next() {
  while (at_ < text_.size()) {
    const char c = text_[at_];
    if (c == ' ' || c == '\t' || c == '\n' || c == '\r') {
      ++at_;
    } else if (c == '#') {
      skip_line();
    } else if (!skip_comment()) {
      return c;
    }
  }
  return 0;
}

bool UsdaScanner::skip_comment() {
  const std::string_view start = text_.substr(at_, 2);
  if (start == "//") {
    skip_line();
    return true;
  }
  if (start != "/*") return false;
  const size_t end = text_.find("*/", at_ + 2);
  if (end == std::string_view::npos) fail("the comment has no end");
  at_ = end + 2;
  return true;
}

void UsdaScanner::skip_line() { at_ = std::min(text_.find('\n', at_), text_.size()); }

bool UsdaScanner::accept(char c) {
  if (next() != c || at_ >= text_.size()) return false;
  ++at_;
  return true;
}

void UsdaScanner::expect(char c) {
  if (!accept(c)) fail_expected(std::string("'") + c + "'");
}

void UsdaScanner::fail_expected(const std::string& what) {
  next();
  if (at_ >= text_.size()) fail("expected " + what + ", but the file ends");
  size_t end = at_;
  while (end < text_.size() && end < at_ + 24 && is_name_part(text_[end])) ++end;
  end = std::max(end, at_ + 1);
  fail("expected " + what + ", found '" + visible(text_.substr(at_, end - at_)) + "'");
}

bool UsdaScanner::at_name() { return is_name_start(next()); }

std::string_view UsdaScanner::name() {
  if (!at_name()) fail_expected("a name");
  const size_t begin = at_;
  while (at_ < text_.size()) {
    const bool colon = text_[at_] == ':' && at_ + 1 < text_.size() && is_name_part(text_[at_ + 1]);
    if (!is_name_part(text_[at_]) && !colon) break;
    ++at_;
  }
  return text_.substr(begin, at_ - begin);
}

void UsdaScanner::skip_quoted() {
  const char quote = text_[at_];
  const std::string three(3, quote);
  if (text_.substr(at_, 3) == three) {
    const size_t first = at_;
    for (at_ += 3;; ++at_) {
      // A backslash at the end of the file leads beyond it.
      if (at_ >= text_.size()) layer_.fail(first, "the text has no closing quotes");
      if (text_.substr(at_, 3) == three) break;
      if (text_[at_] == '\\') ++at_;
    }
    at_ += 3;
    return;
  }
  const size_t begin = at_;
  for (++at_; at_ < text_.size() && text_[at_] != quote && text_[at_] != '\n'; ++at_) {
    if (text_[at_] == '\\') ++at_;
  }
  if (at_ >= text_.size() || text_[at_] != quote) layer_.fail(begin, "the text has no closing quote");
  ++at_;
}

std::string UsdaScanner::quoted() {
  const char quote = next();
  if (quote != '"' && quote != '\'') fail_expected("text in quotes");
  const size_t begin = at_;
  skip_quoted();
  const size_t quotes = at_ - begin >= 6 && text_[begin + 1] == quote && text_[begin + 2] == quote ? 3 : 1;
  std::string result;
  for (size_t i = begin + quotes; i < at_ - quotes; ++i) {
    if (text_[i] != '\\' || i + 1 == at_ - quotes) {
      result += text_[i];
      continue;
    }
    const char c = text_[++i];
    result += c == 'n' ? '\n' : c == 't' ? '\t' : c == 'r' ? '\r' : c;
  }
  return result;
}

void UsdaScanner::skip_asset() {
  const size_t begin = at_;
  const std::string_view quote = text_.substr(at_, 3) == "@@@" ? "@@@" : "@";
  const size_t end = text_.find(quote, at_ + quote.size());
  if (end == std::string_view::npos) layer_.fail(begin, "the name of the file has no closing @");
  at_ = end + quote.size();
}

std::string UsdaScanner::asset() {
  if (next() != '@') fail_expected("a file between @");
  const size_t begin = at_, quotes = text_.substr(at_, 3) == "@@@" ? 3 : 1;
  skip_asset();
  return std::string(text_.substr(begin + quotes, at_ - begin - 2 * quotes));
}

std::string UsdaScanner::path() {
  if (next() != '<') fail_expected("a path between < and >");
  const size_t end = text_.find_first_of(">\n", at_);
  if (end == std::string_view::npos || text_[end] != '>') fail("the path has no closing '>'");
  const std::string result(text_.substr(at_ + 1, end - at_ - 1));
  at_ = end + 1;
  return result;
}

double UsdaScanner::number() {
  if (next() == '+') ++at_;
  double value = 0;
  const char* begin = text_.data() + at_;
  const auto [end, error] = std::from_chars(begin, text_.data() + text_.size(), value);
  if (error == std::errc::invalid_argument) fail_expected("a number");
  at_ += static_cast<size_t>(end - begin);
  return value;
}

void UsdaScanner::skip_brackets() {
  const size_t begin = at_;
  char closing[kMaxBrackets];
  size_t depth = 0;
  for (; at_ < text_.size(); ++at_) {
    while (at_ < text_.size() && !kSpecial[static_cast<unsigned char>(text_[at_])]) ++at_;
    if (at_ == text_.size()) break;
    switch (text_[at_]) {
      case '[':
      case '(':
      case '{':
        if (depth == kMaxBrackets) fail("the brackets are nested deeper than 64 levels");
        closing[depth++] = text_[at_] == '(' ? ')' : static_cast<char>(text_[at_] + 2);
        break;
      case ']':
      case ')':
      case '}':
        if (text_[at_] != closing[depth - 1])
          fail(std::string("expected '") + closing[depth - 1] + "', found '" + text_[at_] + "'");
        if (--depth == 0) {
          ++at_;
          return;
        }
        break;
      case '"':
      case '\'':
        skip_quoted();
        --at_;
        break;
      case '@':
        skip_asset();
        --at_;
        break;
      case '#':
        skip_line();
        --at_;
        break;
      case '/':
        if (skip_comment()) --at_;
        break;
      default:
        break;
    }
  }
  layer_.fail(begin, std::string("the bracket '") + text_[begin] + "' has no end");
}

UsdText UsdaScanner::skip_value() {
  const char c = next();
  const size_t begin = at_;
  if (c == '[' || c == '(' || c == '{') {
    skip_brackets();
  } else if (c == '"' || c == '\'') {
    skip_quoted();
  } else if (c == '@') {
    skip_asset();
    if (next() == '<') path();
  } else if (c == '<') {
    path();
  } else {
    constexpr std::string_view kEnds = " \t\r\n,;()[]{}=#\"'@<>:";
    at_ = std::min(text_.find_first_of(kEnds, at_), text_.size());
    if (at_ == begin) fail_expected("a value");
  }
  return {begin, at_};
}

}  // namespace pelage
