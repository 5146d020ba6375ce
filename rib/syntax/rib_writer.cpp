// SPDX-License-Identifier: Apache-2.0
#include "rib/syntax/rib_writer.h"

#include <bit>
#include <charconv>
#include <cstring>
#include <limits>

namespace pelage {
namespace {

constexpr size_t kBuffer = size_t(256) << 10;
constexpr int kCodes = 256;  // that one byte can tell apart
constexpr size_t kNumbersInLine = 24;

// First bytes of encoded tokens [RISPEC, table C.1].
enum Token : unsigned {
  kInteger = 0200,      // + bytes - 1
  kShortString = 0220,  // + length
  kString = 0240,       // + bytes of the length - 1
  kSingle = 0244,
  kRequest = 0246,
  kFloats = 0310,  // + bytes of the count - 1
  kDefineRequest = 0314,
  kDefineString = 0315,  // + bytes of the code - 1
  kUseString = 0317,     // + bytes of the code - 1
};

int bytes_of(uint64_t value) {
  int bytes = 1;
  while (bytes < 4 && (value >> (8 * bytes)) != 0) ++bytes;
  return bytes;
}

int bytes_of_signed(int32_t value) {
  int bytes = 1;
  while (bytes < 4 && (value < -(1 << (8 * bytes - 1)) || value >= (1 << (8 * bytes - 1)))) ++bytes;
  return bytes;
}

}  // namespace

void RibWriter::big_endian(uint64_t value, int bytes) {
  for (int i = bytes - 1; i >= 0; --i) byte(static_cast<unsigned>(value >> (8 * i)) & 0xffu);
}

void RibWriter::drain() {
  if (buffer_.size() >= kBuffer) flush();
}

void RibWriter::flush() {
  sink_.write(buffer_);
  buffer_.clear();
}

void RibWriter::end_line() {
  if (line_open_) buffer_.push_back('\n');
  line_open_ = false;
}

void RibWriter::comment(std::string_view text) {
  end_line();
  buffer_.push_back('#');
  buffer_.append(text);
  buffer_.push_back('\n');
}

RibWriter& RibWriter::request(std::string_view name) {
  drain();
  if (!binary()) {
    end_line();
    buffer_.append(name);
    line_open_ = true;
    return *this;
  }
  auto known = requests_.find(name);
  if (known == requests_.end()) {  // RI has fewer requests than there are codes
    known = requests_.emplace(std::string(name), static_cast<int>(requests_.size())).first;
    byte(kDefineRequest);
    byte(static_cast<unsigned>(known->second));
    quoted(name);
  }
  byte(kRequest);
  byte(static_cast<unsigned>(known->second));
  return *this;
}

void RibWriter::separate() {
  if (!binary()) buffer_.push_back(' ');
}

void RibWriter::quoted(std::string_view value) {
  if (binary()) {
    if (value.size() < 16) {
      byte(kShortString + static_cast<unsigned>(value.size()));
    } else {
      const int bytes = bytes_of(value.size());
      byte(kString + static_cast<unsigned>(bytes) - 1);
      big_endian(value.size(), bytes);
    }
    buffer_.append(value);
    return;
  }
  buffer_.push_back('"');
  for (const char c : value) {
    if (c == '"' || c == '\\') {
      buffer_.push_back('\\');
      buffer_.push_back(c);
    } else if (c == '\n') {
      buffer_.append("\\n");
    } else {
      buffer_.push_back(c);
    }
  }
  buffer_.push_back('"');
}

RibWriter& RibWriter::text(std::string_view value) {
  separate();
  quoted(value);
  return *this;
}

RibWriter& RibWriter::texts(std::span<const std::string_view> values) {
  separate();
  buffer_.push_back('[');
  for (size_t i = 0; i < values.size(); ++i) {
    if (i) separate();
    quoted(values[i]);
  }
  buffer_.push_back(']');
  return *this;
}

RibWriter& RibWriter::parameter(std::string_view declaration) {
  if (!binary()) return text(declaration);
  auto known = parameters_.find(declaration);
  if (known == parameters_.end()) {
    if (parameters_.size() == kCodes) return text(declaration);
    known = parameters_.emplace(std::string(declaration), static_cast<int>(parameters_.size())).first;
    byte(kDefineString);
    byte(static_cast<unsigned>(known->second));
    quoted(declaration);
  }
  byte(kUseString);
  byte(static_cast<unsigned>(known->second));
  return *this;
}

void RibWriter::plain(float value) {
  char text[32];
  buffer_.append(text, std::to_chars(text, text + sizeof(text), value).ptr);
}

void RibWriter::plain(int32_t value) {
  char text[16];
  buffer_.append(text, std::to_chars(text, text + sizeof(text), value).ptr);
}

RibWriter& RibWriter::integer(int32_t value) {
  separate();
  if (!binary()) {
    plain(value);
    return *this;
  }
  const int bytes = bytes_of_signed(value);
  byte(kInteger + static_cast<unsigned>(bytes) - 1);
  big_endian(static_cast<uint32_t>(value), bytes);
  return *this;
}

RibWriter& RibWriter::number(float value) {
  separate();
  if (!binary()) {
    plain(value);
    return *this;
  }
  byte(kSingle);
  big_endian(std::bit_cast<uint32_t>(value), 4);
  return *this;
}

RibWriter& RibWriter::integers(std::span<const int32_t> values) {
  separate();
  buffer_.push_back('[');
  for (size_t i = 0; i < values.size(); ++i) {
    if (binary()) {
      integer(values[i]);
    } else {
      if (i) buffer_.push_back(i % kNumbersInLine ? ' ' : '\n');
      plain(values[i]);
    }
    drain();
  }
  buffer_.push_back(']');
  return *this;
}

RibWriter& RibWriter::numbers(std::span<const float> values) {
  separate();
  if (!binary()) {
    buffer_.push_back('[');
    for (size_t i = 0; i < values.size(); ++i) {
      if (i) buffer_.push_back(i % kNumbersInLine ? ' ' : '\n');
      plain(values[i]);
      drain();
    }
    buffer_.push_back(']');
    return *this;
  }
  const int bytes = bytes_of(values.size());
  byte(kFloats + static_cast<unsigned>(bytes) - 1);
  big_endian(values.size(), bytes);
  constexpr size_t kBlock = 4096;
  uint32_t swapped[kBlock];
  for (size_t begin = 0; begin < values.size(); begin += kBlock) {
    const size_t count = std::min(kBlock, values.size() - begin);
    for (size_t i = 0; i < count; ++i)
      swapped[i] = __builtin_bswap32(std::bit_cast<uint32_t>(values[begin + i]));
    buffer_.append(reinterpret_cast<const char*>(swapped), count * sizeof(uint32_t));
    drain();
  }
  return *this;
}

}  // namespace pelage
