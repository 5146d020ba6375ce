// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <iostream>
#include <streambuf>

namespace pelage {

/// While it lives, std::cout writes to a descriptor through it, and it remembers whether all of it arrived.
/// One at a time. Line by line on a terminal, in blocks elsewhere.
class StandardOutput final : private std::streambuf {
 public:
  explicit StandardOutput(int descriptor);
  ~StandardOutput() override;
  StandardOutput(const StandardOutput&) = delete;
  StandardOutput& operator=(const StandardOutput&) = delete;

  /// Writes what is left; errno of the first write that failed, or 0.
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
