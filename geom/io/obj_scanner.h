// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <string>
#include <string_view>

#include "base/error.h"

namespace pelage {

/// Scans the statements of an OBJ file, token by token. A statement ends at the end of its line; a backslash
/// at the end of the line continues the statement on the next line. `#` starts a comment.
///
/// The scanner collects problems, with the position of the token, until throw_if_any() is called. It keeps
/// the messages of the first `kMaxProblems` problems and only counts the others, so that a large damaged file
/// does not produce endless messages.
class ObjScanner {
 public:
  static constexpr size_t kMaxProblems = 20;

  /// `text` is the content of the file and must outlive the scanner. `file` is the name of the file in
  /// messages.
  ObjScanner(std::string_view text, std::string file);

  /// Advances to the next statement and sets `keyword` to its first token. Returns false at the end of the
  /// file.
  bool next_statement(std::string_view& keyword);
  /// Reads the next token of the current statement. Returns false when the statement has no more tokens.
  bool next_token(std::string_view& token);
  /// Reads the rest of the current line, including a comment, and returns it without surrounding blanks.
  std::string_view rest();

  /// Line number of the token that was read last, counted from 1.
  int line() const { return token_line_; }

  /// number() reads the next token as a finite number, integer() as an integer. If the token is missing or
  /// malformed, they report a problem and return false. `what` describes the expected value in the message of
  /// this problem, such as "a vertex index".
  bool number(const char* what, float& value);
  bool integer(const char* what, int64_t& value);
  /// parse_number() and parse_integer() do the same for `token`, which is a token that has already been read,
  /// or a part of such a token.
  bool parse_number(std::string_view token, const char* what, float& value);
  bool parse_integer(std::string_view token, const char* what, int64_t& value);

  /// report() adds a problem at the token that was read last. report_line() adds a problem at line `line`.
  void report(std::string message);
  void report_line(int line, std::string message);
  /// Throws an Error (kInput) with all reported problems, sorted by line. Returns if there are none.
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

/// Returns the first 40 characters of `text` in single quotes, for messages, with `?` for each character that
/// is not printable. A longer text ends with "...".
std::string quoted_excerpt(std::string_view text);

}  // namespace pelage
