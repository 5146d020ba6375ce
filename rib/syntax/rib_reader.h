// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <filesystem>
#include <functional>
#include <string>
#include <vector>

#include "rib/syntax/rib_lexer.h"

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
  /// `check`: called before the arguments of one request take more than 1 MiB, and again each time before
  /// their size doubles. May throw. A short compressed file may have huge arguments.
  RibReader(const std::filesystem::path& path, std::function<void(size_t bytes)> check)
      : lexer_(path, [this](size_t bytes) { charge(bytes); }), check_(std::move(check)) {}
  explicit RibReader(const std::filesystem::path& path) : RibReader(path, {}) {}
  RibReader(const RibReader&) = delete;
  RibReader& operator=(const RibReader&) = delete;

  /// Reads the next request into `request`, whose memory is reused. Returns false at the end of the file.
  bool next(RibStatement& request);

 private:
  RibOperand& add_argument(RibStatement& request);
  void read_array(RibStatement& request);
  void append_number(RibOperand& argument);
  void read_value(RibStatement& request, RibToken token);

  /// Counts bytes of the arguments of a request before they are taken.
  void charge(size_t bytes) {
    charged_ += bytes;
    if (charged_ <= allowed_) return;
    while (allowed_ < charged_) allowed_ *= 2;
    if (check_) check_(allowed_);
  }

  static constexpr size_t kUnchecked = size_t(1) << 20;
  RibLexer lexer_;
  std::function<void(size_t)> check_;
  size_t charged_ = 0, allowed_ = kUnchecked;
  bool started_ = false;
  RibToken ahead_ = RibToken::kEnd;  // the token after the last argument
  size_t used_ = 0;                  // arguments of the present request
};

}  // namespace pelage
