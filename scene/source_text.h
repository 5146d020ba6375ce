// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "base/error.h"

namespace pelage {

/// Holds the text of a scene file. Converts byte positions to lines and columns for messages. Lines and
/// columns of a SourcePosition count from 1. Columns count characters as an editor does, not bytes.
class SourceText {
 public:
  /// Removes a byte order mark from the start of `text`. `file`: file name for positions.
  SourceText(std::string text, std::string file);

  const std::string& text() const { return text_; }
  const std::string& file() const { return file_; }

  /// Returns a line, counted from 0, without its '\n'. Returns an empty text when the line does not exist.
  std::string_view line(int line) const;

  /// Returns the position of a byte in a line. Both arguments count from 0, and are clamped to the text. Fast
  /// if calls for the same line have ascending columns.
  SourcePosition position(int line, int byte_column);

  /// Returns the position of a byte, given its offset in the whole text.
  SourcePosition position_of_byte(size_t byte);

  /// Returns why the text cannot be parsed safely; empty if it can. The text must be UTF-8, without control
  /// characters, and with at most 256 brackets open at once, because yaml-cpp allocates 256 bytes for each
  /// open bracket before it reports anything.
  std::optional<Problem> mistake();

 private:
  std::string text_;
  std::string file_;
  std::vector<size_t> line_starts_;
  // Line and byte where the last count of characters ended, and its result. The next call for this line
  // starts there, so that a long line is not counted again for each of its values.
  int counted_line_ = -1;
  size_t counted_bytes_ = 0;
  int counted_characters_ = 0;
};

}  // namespace pelage
