// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <string>
#include <string_view>

#include "base/error.h"

namespace pelage {

/// Scans the statements of an OBJ file, token by token, with their positions. A statement ends with its line,
/// unless the line ends with a backslash; `#` starts a comment. Problems are collected; after the first
/// `kMaxProblems` they are only counted, so that a damaged file of gigabytes causes a page of errors.
class ObjScanner {
 public:
  static constexpr size_t kMaxProblems = 20;

  /// `text` must outlive the scanner; `file` names it in problems.
  ObjScanner(std::string_view text, std::string file);

  /// Advances to the next statement and returns its keyword; false at the end of the file.
  bool next_statement(std::string_view& keyword);
  /// The next token of this statement; false when there is none left.
  bool next_token(std::string_view& token);
  /// The rest of this statement, without surrounding blanks.
  std::string_view rest();

  /// Line of the token that was read last, from 1.
  int line() const { return token_line_; }

  /// Reads the next token as a finite number or an integer. Reports problems; `what`: the expected value, for
  /// the message.
  bool number(const char* what, float& value);
  bool integer(const char* what, int64_t& value);
  /// The same for a token, or a part of one, that has already been read.
  bool parse_number(std::string_view token, const char* what, float& value);
  bool parse_integer(std::string_view token, const char* what, int64_t& value);

  /// report() adds a problem at the token that was read last, report_line() at an earlier line.
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

/// An excerpt of a file for messages: short, printable, quoted.
std::string quoted_excerpt(std::string_view text);

}  // namespace pelage
