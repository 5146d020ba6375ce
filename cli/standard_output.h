// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <iostream>
#include <streambuf>

namespace pelage {

/// While this object exists, std::cout writes through it to `descriptor`. It records failed writes. Only one
/// instance may exist at a time. On a terminal, it writes after every line; otherwise, it writes whenever its
/// buffer is full.
class StandardOutput final : private std::streambuf {
 public:
  explicit StandardOutput(int descriptor);
  ~StandardOutput() override;
  StandardOutput(const StandardOutput&) = delete;
  StandardOutput& operator=(const StandardOutput&) = delete;

  /// Writes the rest of the buffer. Returns errno of the first failed write, or 0 if no write failed.
  int finish();

 private:
  int overflow(int c) override;
  int sync() override;
  std::streamsize xsputn(const char* text, std::streamsize size) override;
  void flush();

  int descriptor_;
  bool by_line_;
  int failure_ = 0;
  std::streambuf* old_;
  std::array<char, 1 << 16> buffer_;
};

}  // namespace pelage
