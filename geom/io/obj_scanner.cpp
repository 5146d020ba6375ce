// SPDX-License-Identifier: Apache-2.0
#include "geom/io/obj_scanner.h"

#include <algorithm>
#include <charconv>
#include <cmath>

#include <fmt/format.h>

namespace pelage {

namespace {

bool is_blank(char c) { return c == ' ' || c == '\t' || c == '\r' || c == '\v' || c == '\f'; }

/// Length of a backslash that joins two lines, including the line end; 0 when there is none at `at`.
size_t continuation(std::string_view text, size_t at) {
  if (text[at] != '\\') return 0;
  if (at + 1 < text.size() && text[at + 1] == '\n') return 2;
  if (at + 2 < text.size() && text[at + 1] == '\r' && text[at + 2] == '\n') return 3;
  return 0;
}

}  // namespace

std::string quoted_excerpt(std::string_view text) {
  constexpr size_t kLongest = 40;
  std::string result = "'";
  for (char c : text.substr(0, kLongest)) result += c >= ' ' && c <= '~' ? c : '?';
  return result + (text.size() > kLongest ? "...'" : "'");
}

ObjScanner::ObjScanner(std::string_view text, std::string file) : text_(text), file_(std::move(file)) {}

void ObjScanner::skip_blanks() {
  while (at_ < text_.size()) {
    if (is_blank(text_[at_])) {
      ++at_;
    } else if (const size_t length = continuation(text_, at_)) {
      at_ += length;
      line_start_ = at_;
      ++line_;
    } else {
      break;
    }
  }
}

bool ObjScanner::at_end_of_statement() const {
  return at_ >= text_.size() || text_[at_] == '\n' || text_[at_] == '#';
}

bool ObjScanner::next_token(std::string_view& token) {
  skip_blanks();
  token_line_ = line_;
  token_column_ = static_cast<int>(at_ - line_start_) + 1;
  if (at_end_of_statement()) return false;
  const size_t begin = at_;
  while (at_ < text_.size() && text_[at_] != '\n' && !is_blank(text_[at_]) && !continuation(text_, at_))
    ++at_;
  token = text_.substr(begin, at_ - begin);
  return true;
}

bool ObjScanner::next_statement(std::string_view& keyword) {
  while (true) {
    if (started_) {
      at_ = text_.find('\n', at_);
      if (at_ >= text_.size()) return false;
      ++at_;
      line_start_ = at_;
      ++line_;
    }
    started_ = true;
    if (next_token(keyword)) return true;
  }
}

std::string_view ObjScanner::rest() {
  skip_blanks();
  const size_t begin = at_;
  at_ = std::min(text_.find('\n', at_), text_.size());
  size_t end = at_;
  while (end > begin && is_blank(text_[end - 1])) --end;
  return text_.substr(begin, end - begin);
}

bool ObjScanner::parse_number(std::string_view token, const char* what, float& value) {
  const std::string_view digits = token.starts_with('+') ? token.substr(1) : token;
  double parsed = 0;
  const auto [end, status] = std::from_chars(digits.data(), digits.data() + digits.size(), parsed);
  if (status == std::errc::invalid_argument || end != digits.data() + digits.size()) {
    report(fmt::format("expected {}, got {}", what, quoted_excerpt(token)));
    return false;
  }
  value = static_cast<float>(parsed);
  if (status == std::errc::result_out_of_range || !std::isfinite(value)) {
    report(fmt::format("expected {} that a float can hold, got {}", what, quoted_excerpt(token)));
    return false;
  }
  return true;
}

bool ObjScanner::parse_integer(std::string_view token, const char* what, int64_t& value) {
  const auto [end, status] = std::from_chars(token.data(), token.data() + token.size(), value);
  if (status == std::errc() && end == token.data() + token.size()) return true;
  report(fmt::format("expected {}, got {}", what, quoted_excerpt(token)));
  return false;
}

bool ObjScanner::number(const char* what, float& value) {
  std::string_view token;
  if (next_token(token)) return parse_number(token, what, value);
  report(fmt::format("expected {}, got the end of the line", what));
  return false;
}

bool ObjScanner::integer(const char* what, int64_t& value) {
  std::string_view token;
  if (next_token(token)) return parse_integer(token, what, value);
  report(fmt::format("expected {}, got the end of the line", what));
  return false;
}

void ObjScanner::report(std::string message) {
  problems_.add({file_, token_line_, token_column_}, std::move(message));
}

void ObjScanner::report_line(int line, std::string message) {
  problems_.add({file_, line, 0}, std::move(message));
}

void ObjScanner::throw_if_any() {
  problems_.sort_by_line();
  problems_.throw_if_any();
}

}  // namespace pelage
