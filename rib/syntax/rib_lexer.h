// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <functional>
#include <map>
#include <string>
#include <vector>

#include "rib/syntax/rib_bytes.h"

namespace pelage {

enum class RibToken { kRequest, kString, kInteger, kFloat, kFloats, kOpen, kClose, kEnd };

/// Max number of elements of an array, and of bytes of a string. A file that claims more is refused.
inline constexpr uint64_t kMaxRibCount = 1'000'000'000;
inline constexpr uint64_t kMaxRibString = uint64_t(1) << 24;
inline constexpr uint64_t kMaxRibDefinitions = uint64_t(1) << 26;  ///< bytes of all strings that have codes

/// Splits a RIB file into tokens [RISPEC 3.2, C.2]. Text and binary encodings may be mixed. A float array of
/// the binary encoding is one token kFloats, without brackets. All errors are Error (kInput) with file, line
/// and column. In binary parts, the column is the number of bytes since the last line feed of the text.
class RibLexer {
 public:
  /// `grows`: called with the number of bytes before a float array takes this much more memory; may throw.
  RibLexer(const std::filesystem::path& path, std::function<void(size_t bytes)> grows)
      : bytes_(path), grows_(std::move(grows)) {}
  explicit RibLexer(const std::filesystem::path& path) : RibLexer(path, {}) {}

  /// Reads the next token. The values of the token are valid until the next call.
  RibToken next();

  const std::string& text() const { return text_; }             ///< of kRequest and kString
  int64_t integer() const { return integer_; }                  ///< of kInteger
  double number() const { return number_; }                     ///< of kFloat
  const std::vector<float>& floats() const { return floats_; }  ///< of kFloats
  /// Exchanges the values of kFloats for other memory, which is reused.
  void swap_floats(std::vector<float>& other) { floats_.swap(other); }
  /// Position of the first byte of the token.
  SourcePosition position() const { return {bytes_.file(), line_, column_}; }
  int line() const { return line_; }
  int column() const { return column_; }
  const std::string& file() const { return bytes_.file(); }

 private:
  [[noreturn]] void fail(const std::string& why) const;
  void skip_blanks();
  RibToken read_text(int first);
  RibToken read_word();
  RibToken read_number();
  void read_quoted();
  int read_escape();
  RibToken read_binary();
  RibToken read_binary_integer(int code);
  RibToken read_binary_string(uint64_t length);
  RibToken read_binary_floats(int length_bytes);
  void define_string(int code_bytes);
  uint64_t unsigned_operand(int bytes);

  RibBytes bytes_;
  std::function<void(size_t)> grows_;
  int line_ = 1, column_ = 1;
  std::string text_;
  int64_t integer_ = 0;
  double number_ = 0;
  std::vector<float> floats_;
  std::map<uint64_t, std::string> requests_, strings_;  // of the binary encoding, by code
  uint64_t defined_bytes_ = 0;                          // of all definitions in requests_ and strings_ so far
};

}  // namespace pelage
