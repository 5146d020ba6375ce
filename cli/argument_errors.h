// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>

namespace CLI {
class App;
}

namespace pelage {

/// Throws Error (kArguments).
[[noreturn]] void fail_arguments(const std::string& message);

/// Throws Error (kArguments) for the arguments that the parser of a command did not use. For a flag, the
/// message suggests the nearest known one.
[[noreturn]] void fail_extras(const CLI::App& app);

/// Throws Error (kArguments) for a flag with an empty file name, such as that of an unset shell variable.
/// Otherwise, an empty name would mean the default.
void check_file_names(const CLI::App& app);

}  // namespace pelage
