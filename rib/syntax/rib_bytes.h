// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <memory>
#include <string>
#include <vector>

#include "base/error.h"

namespace pelage {

/// The bytes of a RIB file in order, with their positions. A file that begins like a gzip file is
/// decompressed. Takes a fixed amount of memory for any file.
class RibBytes {
 public:
  static constexpr int kEnd = -1;

  /// Throws Error (kInput) when the file cannot be read, is not a regular file or is what
  /// foreign_text() knows.
  explicit RibBytes(const std::filesystem::path& path);
  ~RibBytes();

  /// Returns the next byte without taking it; kEnd after the last byte. Throws Error (kInput) if compressed
  /// data is damaged or cut off. Also throws if the data is larger than 64 MiB and than 200 times the bytes
  /// read from the file, because a file of a few kilobytes could otherwise fill the memory.
  int peek() { return next_ < end_ || fill() ? buffer_[next_] : kEnd; }
  /// Takes the next byte of text. Counts lines.
  int take() {
    const int byte = peek();
    if (byte == kEnd) return kEnd;
    ++next_;
    ++column_;
    if (byte == '\n') {
      ++line_;
      column_ = 1;
    }
    return byte;
  }
  /// Takes `count` bytes of binary data, in which a line feed has no meaning. Throws Error (kInput) with
  /// `what` if the file ends before.
  void take_binary(void* to, size_t count, const char* what);

  /// Position of the next byte.
  SourcePosition position() const { return {*file_, line_, column_}; }
  int line() const { return line_; }
  int column() const { return column_; }
  const std::string& file() const { return *file_; }

 private:
  bool fill();

  struct Stream;
  std::unique_ptr<Stream> stream_;
  std::shared_ptr<const std::string> file_;
  std::vector<uint8_t> buffer_;
  size_t next_ = 0, end_ = 0;
  int line_ = 1, column_ = 1;
};

}  // namespace pelage
