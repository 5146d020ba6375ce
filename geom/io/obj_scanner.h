// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <string>
#include <string_view>

#include "base/error.h"

namespace pelage {

/// Walks over the statements of an OBJ file, token by token, and remembers where it is. A statement ends with
/// its line, unless the line ends with a backslash; `#` starts a comment. Problems are collected, and beyond
/// the first `kMaxProblems` only counted, so that a damaged file of gigabytes gives a page of errors.
class ObjScanner {
 public:
  static constexpr size_t kMaxProblems = 20;

  /// `text` must outlive the scanner; `file` names it in problems.
  ObjScanner(std::string_view text, std::string file);

  /// Goes to the next statement and gives its keyword; false at the end of the file.
  bool next_statement(std::string_view& keyword);
  /// Next token of this statement; false when there is none left.
  bool next_token(std::string_view& token);
  /// What is left of this statement, without blanks around it.
  std::string_view rest();

  /// Line of the token that was read last, from 1.
  int line() const { return token_line_; }

  /// The next token as a finite number or a whole number. Reports what is wrong, `what` saying what was
  /// expected.
  bool number(const char* what, float& value);
  bool integer(const char* what, int64_t& value);
  /// The same for a token, or a part of one, that has been read already.
  bool parse_number(std::string_view token, const char* what, float& value);
  bool parse_integer(std::string_view token, const char* what, int64_t& value);

  /// Reports a problem at the token that was read last, or at a line that was passed before.
  void report(std::string message);
  void report_line(int line, std::string message);
  /// Throws an Error (kInput) with everything that was reported, in order of lines.
  void throw_if_any();

 private:
  void skip_blanks();
  bool at_end_of_statement() const;

  std::string_view text_;
  std::string file_;
  bool started_ = false;
  size_t at_ = 0;
  size_t line_start_ = 0;
  int line_ = 1;
  int token_line_ = 1;
  int token_column_ = 1;
  Problems problems_{kMaxProblems};
};

/// A piece of a file as it may stand in a message: short, printable, in quotes.
std::string quoted_excerpt(std::string_view text);

}  // namespace pelage
