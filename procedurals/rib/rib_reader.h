// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <filesystem>
#include <string>
#include <vector>

#include "procedurals/rib/rib_lexer.h"

namespace pelage {

/// One argument of a request: a number, a string, or an array of either. An array is one of integers if all
/// its numbers are integers, and one of floats otherwise.
struct RibOperand {
  enum class Kind { kIntegers, kFloats, kStrings };
  Kind kind = Kind::kIntegers;
  bool is_array = false;
  int line = 0, column = 0;
  std::vector<int64_t> integers;
  std::vector<float> floats;
  std::vector<std::string> strings;

  size_t size() const {
    return kind == Kind::kIntegers ? integers.size() : kind == Kind::kFloats ? floats.size() : strings.size();
  }
  bool is_number() const { return kind != Kind::kStrings; }
  /// Number `i` of an argument that has numbers.
  float number(size_t i) const {
    return kind == Kind::kIntegers ? static_cast<float>(integers[i]) : floats[i];
  }
  /// "a string", "an array of 3 integers": for messages.
  std::string describe() const;
};

/// A request with its arguments, such as Translate 0 0 5.
struct RibStatement {
  std::string name;
  std::string file;
  int line = 0, column = 0;
  std::vector<RibOperand> arguments;

  SourcePosition position() const { return {file, line, column}; }
  SourcePosition position(const RibOperand& argument) const { return {file, argument.line, argument.column}; }
  [[noreturn]] void fail(const std::string& why) const;
  [[noreturn]] void fail(const RibOperand& argument, const std::string& why) const;
  /// Heap bytes, for requests that are kept.
  size_t bytes() const;
};

/// Reads a RIB file request by request. Does not know what requests mean. Throws Error (kInput).
class RibReader {
 public:
  explicit RibReader(const std::filesystem::path& path) : lexer_(path) {}

  /// Reads the next request into `request`, whose memory is reused. Returns false at the end of the file.
  bool next(RibStatement& request);

 private:
  RibOperand& add_argument(RibStatement& request);
  void read_array(RibStatement& request);
  void append_number(RibOperand& argument);
  void read_value(RibStatement& request, RibToken token);

  RibLexer lexer_;
  bool started_ = false;
  RibToken ahead_ = RibToken::kEnd;  // the token after the last argument
  size_t used_ = 0;                  // arguments of the present request
};

}  // namespace pelage
