// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <iostream>
#include <streambuf>

namespace pelage {

/// During its lifetime, std::cout writes to a descriptor through this object, which records failures. Only
/// one instance may exist at a time. Line-buffered on a terminal, otherwise in blocks.
class StandardOutput final : private std::streambuf {
 public:
  explicit StandardOutput(int descriptor);
  ~StandardOutput() override;
  StandardOutput(const StandardOutput&) = delete;
  StandardOutput& operator=(const StandardOutput&) = delete;

  /// Flushes; returns errno of the first failed write, or 0.
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
