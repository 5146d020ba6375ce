// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>
#include <string_view>
#include <vector>

#include "base/error.h"

namespace pelage {

/// The text of a scene file and where its lines begin. Lines and columns count from 1; columns count
/// characters as an editor does, not bytes.
class SourceText {
 public:
  /// A byte order mark is dropped. `file` is what positions say.
  SourceText(std::string text, std::string file);

  const std::string& text() const { return text_; }
  const std::string& file() const { return file_; }

  /// A line, counted from 0, without its end; empty when there is none.
  std::string_view line(int line) const;

  /// Position of a byte of a line, both counted from 0; places beyond the text become its end. Quick when
  /// asked in ascending order.
  SourcePosition position(int line, int byte_column);

  /// The same of a byte of the whole text.
  SourcePosition position_of_byte(size_t byte);

  /// Adds a problem and returns false when the text is not UTF-8, holds control characters, or opens brackets
  /// by the hundred: yaml-cpp queues a quarter kilobyte for each before its first event.
  bool check(Problems& problems);

 private:
  std::string text_;
  std::string file_;
  std::vector<size_t> line_starts_;
  // Where the last count of characters stopped, so that a long line is not counted again for each of its
  // values.
  int counted_line_ = -1;
  size_t counted_bytes_ = 0;
  int counted_characters_ = 0;
};

}  // namespace pelage
