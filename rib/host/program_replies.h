// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <exception>
#include <istream>
#include <string>
#include <string_view>

#include "rib/host/hair_node.h"
#include "rib/syntax/rib_sink.h"

namespace pelage {

/// Describes an exception on a single line of at most about 1,000 bytes. If an Error has several problems,
/// states the first and their number.
std::string one_line(const std::exception& error);

/// Max length of a request, in bytes.
inline constexpr size_t kMaxProgramRequest = size_t(1) << 20;

/// Reads a request up to its line feed. Of a longer request than kMaxProgramRequest, keeps this many bytes
/// and one more, and skips the rest. Returns false at the end of the input.
bool read_program_request(std::istream& input, std::string& request);

/// Replies to the requests that a renderer sends to a program of RunProgram. Every request is a line "detail
/// arguments", see subdivide_request(). The reply is RIB in ASCII and ends with a byte 255. Nested
/// procedurals are requests to the same program.
class ProgramReplies {
 public:
  /// `command`: text by which the replies name the program.
  explicit ProgramReplies(std::string command) : command_(std::move(command)) {}

  /// Writes the reply to a request. Returns an empty text, or one line that describes why the reply has no
  /// hair. Passes on the exceptions of `sink`.
  std::string reply(std::string_view request, RibSink& sink);

 private:
  const std::string command_;
  HairSessions sessions_;
};

}  // namespace pelage
