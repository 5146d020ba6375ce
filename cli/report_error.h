// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>

#include "base/error.h"

namespace pelage {

/// Returns the exit code of the process for a kind of error. docs/RUNNING.md lists these codes.
int exit_code(ErrorKind kind);

/// Returns the text that the user sees. It has one line per problem: "file:line:column: message", or "pelage:
/// error: message" for a problem without a position. It shows at most 50 problems; a last line then states
/// how many more there are.
std::string error_text(const Error& error);

}  // namespace pelage
