// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>

#include "base/error.h"

namespace pelage {

/// Exit code of the process for a kind of error; docs/RUNNING.md lists the codes.
int exit_code(ErrorKind kind);

/// What the user sees: a line "file:line:column: message" per problem, "pelage: error: message" where there
/// is no position, and a last line with the number of those that are left out when there are very many.
std::string error_text(const Error& error);

}  // namespace pelage
