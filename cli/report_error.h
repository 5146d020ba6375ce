// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>

#include "base/error.h"

namespace pelage {

/// Exit code of the process for a kind of error; docs/RUNNING.md lists the codes.
int exit_code(ErrorKind kind);

/// The text shown to the user: a line "file:line:column: message" per problem, "pelage: error: message"
/// without a position, and a last line with the number of problems omitted when there are very many.
std::string error_text(const Error& error);

}  // namespace pelage
