// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <exception>
#include <limits>
#include <string>
#include <vector>

namespace pelage {

/// A position in an input. Line and column count from 1; 0 means that the input has no lines.
struct SourcePosition {
  std::string file;
  int line = 0;
  int column = 0;
};

/// "file:line:column", without the parts that are unknown.
std::string to_string(const SourcePosition& position);

/// One mistake of the user, or one failure of the system, as one line without a final full stop.
struct Problem {
  SourcePosition position;
  std::string message;
};

/// What an error means for the exit code of the command (docs/RUNNING.md).
enum class ErrorKind {
  kFailed,     ///< render failed or an output could not be written: 1
  kArguments,  ///< bad arguments: 2
  kInput,      ///< a scene or an asset is missing, malformed or damaged: 3
  kMemory,     ///< the memory budget is too small: 4
  kStopped,    ///< the user asked to stop and there is nothing to show: 130
};

/// The only exception type for mistakes of the user and failures of the system. Carries every problem found,
/// in file order. Bugs are not errors: they abort the program (base/check.h).
class Error : public std::exception {
 public:
  Error(ErrorKind kind, std::vector<Problem> problems);
  Error(ErrorKind kind, std::string message) : Error(kind, std::vector<Problem>{{{}, std::move(message)}}) {}
  Error(ErrorKind kind, SourcePosition position, std::string message)
      : Error(kind, std::vector<Problem>{{std::move(position), std::move(message)}}) {}

  ErrorKind kind() const { return kind_; }
  const std::vector<Problem>& problems() const { return problems_; }
  /// One line per problem: "file:line:column: message".
  const char* what() const noexcept override { return text_.c_str(); }

 private:
  ErrorKind kind_;
  std::vector<Problem> problems_;
  std::string text_;
};

/// Collects problems while a file is read, so that all are reported together.
class Problems {
 public:
  Problems() = default;
  /// Keeps the first `max` problems and only counts the rest, because a damaged file may contain very many.
  explicit Problems(size_t max) : max_(max) {}

  void add(SourcePosition position, std::string message) {
    if (list_.size() < max_) {
      list_.push_back({std::move(position), std::move(message)});
    } else {
      ++omitted_;
    }
  }
  bool empty() const { return list_.empty(); }
  /// Sorts by line. For code that reads a single file and finds some mistakes only at the end of the file.
  void sort_by_line();
  const std::vector<Problem>& list() const { return list_; }
  /// Throws an Error of `kind` with all problems, if there are any. States how many more were only counted.
  void throw_if_any(ErrorKind kind = ErrorKind::kInput) const;

 private:
  std::vector<Problem> list_;
  size_t max_ = std::numeric_limits<size_t>::max();
  size_t omitted_ = 0;
};

}  // namespace pelage
