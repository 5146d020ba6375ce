// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>
#include <string_view>
#include <vector>

#include "base/error.h"

namespace pelage {

/// The text of a scene file and its line starts. Lines and columns count from 1; columns count characters as
/// an editor does, not bytes.
class SourceText {
 public:
  /// Skips a byte order mark. `file`: file name in positions.
  SourceText(std::string text, std::string file);

  const std::string& text() const { return text_; }
  const std::string& file() const { return file_; }

  /// A line, counted from 0, without its line end; empty when it does not exist.
  std::string_view line(int line) const;

  /// Position of a byte of a line, both counted from 0; positions beyond the text are clamped to its end.
  /// Fast for ascending queries.
  SourcePosition position(int line, int byte_column);

  /// The same for a byte offset in the whole text.
  SourcePosition position_of_byte(size_t byte);

  /// Adds a problem and returns false when the text is not UTF-8, contains control characters, or opens
  /// hundreds of brackets: yaml-cpp queues a quarter kilobyte for each bracket before its first event.
  bool check(Problems& problems);

 private:
  std::string text_;
  std::string file_;
  std::vector<size_t> line_starts_;
  // Where the last character count ended, so that a long line is not counted again for each of its values.
  int counted_line_ = -1;
  size_t counted_bytes_ = 0;
  int counted_characters_ = 0;
};

}  // namespace pelage
