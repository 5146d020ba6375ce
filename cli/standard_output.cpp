// SPDX-License-Identifier: Apache-2.0
#include "cli/standard_output.h"

#include <cerrno>
#include <cstring>

#include <unistd.h>

namespace pelage {

StandardOutput::StandardOutput(int descriptor)
    : descriptor_(descriptor), by_line_(::isatty(descriptor) == 1), old_(std::cout.rdbuf(this)) {
  setp(buffer_.data(), buffer_.data() + buffer_.size());
}

StandardOutput::~StandardOutput() {
  flush();
  std::cout.rdbuf(old_);
}

int StandardOutput::finish() {
  flush();
  return failure_;
}

void StandardOutput::flush() {
  for (const char* next = pbase(); next < pptr() && failure_ == 0;) {
    const ssize_t n = ::write(descriptor_, next, static_cast<size_t>(pptr() - next));
    if (n >= 0) next += n;
    if (n < 0 && errno != EINTR) failure_ = errno;
  }
  setp(buffer_.data(), buffer_.data() + buffer_.size());
}

int StandardOutput::overflow(int c) {
  flush();
  if (failure_ != 0) return traits_type::eof();
  if (!traits_type::eq_int_type(c, traits_type::eof())) sputc(traits_type::to_char_type(c));
  return traits_type::not_eof(c);
}

int StandardOutput::sync() {
  flush();
  return failure_ == 0 ? 0 : -1;
}

std::streamsize StandardOutput::xsputn(const char* text, std::streamsize size) {
  const std::streamsize put = std::streambuf::xsputn(text, size);
  if (by_line_ && std::memchr(text, '\n', static_cast<size_t>(size))) flush();
  return failure_ == 0 ? put : 0;
}

}  // namespace pelage
