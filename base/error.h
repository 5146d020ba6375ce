// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <exception>
#include <limits>
#include <string>
#include <vector>

namespace pelage {

/// A position in an input file. Line and column count from 1; 0 means unknown or that the file has no lines.
struct SourcePosition {
  std::string file;
  int line = 0;
  int column = 0;
};

/// Returns "file:line:column", or "file:line" or "file" when the rest is unknown.
std::string to_string(const SourcePosition& position);

/// One mistake of the user, or one failure of the system. The message is one line without a final full stop.
struct Problem {
  SourcePosition position;
  std::string message;
};

/// Kinds of errors. Each has its own exit code of the command, stated behind the colon (docs/RUNNING.md).
enum class ErrorKind {
  kFailed,     ///< the render failed or an output could not be written: 1
  kArguments,  ///< bad arguments: 2
  kInput,      ///< a scene or an asset is missing, malformed or damaged: 3
  kMemory,     ///< the memory budget is too small: 4
  kStopped,    ///< the user asked to stop before there was any result: 130
};

/// The only exception type for mistakes of the user and failures of the system. Contains all problems that
/// were found, in the order of the file. Bugs are not errors: they abort the program (base/check.h).
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
  /// Keeps the first `max` problems and only counts the others, because a damaged file may cause millions.
  explicit Problems(size_t max) : max_(max) {}

  void add(SourcePosition position, std::string message) {
    if (list_.size() < max_) {
      list_.push_back({std::move(position), std::move(message)});
    } else {
      ++omitted_;
    }
  }
  bool empty() const { return list_.empty(); }
  /// Sorts the problems by line. For readers of a single file that find some mistakes only at its end.
  void sort_by_line();
  const std::vector<Problem>& list() const { return list_; }
  /// Throws an Error of `kind` if there are problems; otherwise does nothing. The error contains the kept
  /// problems, and the count of the others as one more problem.
  void throw_if_any(ErrorKind kind = ErrorKind::kInput) const;

 private:
  std::vector<Problem> list_;
  size_t max_ = std::numeric_limits<size_t>::max();
  size_t omitted_ = 0;
};

}  // namespace pelage
