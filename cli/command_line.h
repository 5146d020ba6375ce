// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <iosfwd>
#include <memory>
#include <string>
#include <vector>

namespace CLI {
class App;
}

namespace pelage {

/// Throws Error (kArguments).
[[noreturn]] void fail_arguments(const std::string& message);

/// Creates the command-line parser of a program, with the flags that every program has. `footer`: last line
/// of --help.
std::unique_ptr<CLI::App> make_parser(const std::string& description, const std::string& program,
                                      const std::string& footer);

/// Parses a command line, whose first word is one of the commands of `app`. Returns false when help or the
/// version was requested, after writing that text to `out`. Throws Error (kArguments) for mistakes. For an
/// unknown command or flag, the message suggests the nearest known name. Refuses flags with an empty file
/// name, such as that of an unset shell variable: it would mean the default.
bool parse_command_line(CLI::App& app, const std::vector<std::string>& arguments, std::ostream& out);

}  // namespace pelage
