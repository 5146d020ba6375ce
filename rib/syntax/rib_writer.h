// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <initializer_list>
#include <map>
#include <span>
#include <string>
#include <string_view>

#include "rib/syntax/rib_sink.h"

namespace pelage {

enum class RibEncoding { kAscii, kBinary };

/// Writes requests of the RenderMan Interface Bytestream to a sink [RISPEC, appendix C]. A request is its
/// name followed by its arguments, in the order of the calls:
///
///   rib.request("Projection").text("perspective").parameter("float fov").numbers({40});
///
/// ASCII numbers have as many digits as are needed to read the same float again, so both encodings carry the
/// same values. Binary streams define a code for each request and each parameter when it is first used.
class RibWriter {
 public:
  /// `sink` must outlive this object.
  RibWriter(RibSink& sink, RibEncoding encoding) : sink_(sink), encoding_(encoding) {}
  RibWriter(const RibWriter&) = delete;
  RibWriter& operator=(const RibWriter&) = delete;

  /// Writes a line "#text". The text must not contain a line break.
  void comment(std::string_view text);
  RibWriter& request(std::string_view name);
  RibWriter& text(std::string_view value);
  RibWriter& texts(std::span<const std::string_view> values);
  RibWriter& texts(std::initializer_list<std::string_view> values) {
    return texts(std::span(values.begin(), values.size()));
  }
  /// Writes a declaration such as "uniform color Cs", which usually occurs many times in a file.
  RibWriter& parameter(std::string_view declaration);
  RibWriter& integer(int32_t value);
  RibWriter& number(float value);
  RibWriter& integers(std::span<const int32_t> values);
  RibWriter& integers(std::initializer_list<int32_t> values) {
    return integers(std::span(values.begin(), values.size()));
  }
  RibWriter& numbers(std::span<const float> values);
  RibWriter& numbers(std::initializer_list<float> values) {
    return numbers(std::span(values.begin(), values.size()));
  }
  /// Ends a line in ASCII. Without this call, the last request of a stream is not ended by white space.
  void end_line();
  /// Passes everything written so far to the sink. The destructor does not do this, because a sink may throw.
  void flush();

 private:
  bool binary() const { return encoding_ == RibEncoding::kBinary; }
  void byte(unsigned value) { buffer_.push_back(static_cast<char>(static_cast<unsigned char>(value))); }
  void big_endian(uint64_t value, int bytes);
  void separate();
  void quoted(std::string_view value);
  void plain(float value);
  void plain(int32_t value);
  void drain();

  RibSink& sink_;
  RibEncoding encoding_;
  std::string buffer_;
  std::map<std::string, int, std::less<>> requests_, parameters_;  // codes
  bool line_open_ = false;
};

}  // namespace pelage
