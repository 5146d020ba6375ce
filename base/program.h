// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>
#include <optional>
#include <string>
#include <vector>

namespace pelage {

/// Returns the path of the running program.
std::filesystem::path current_program();

/// Looks for a program that can be run, in `folders` and then, unless the name has a slash, on PATH. An
/// absolute `name` is only checked. Returns its absolute path.
std::optional<std::filesystem::path> find_program(const std::string& name,
                                                  std::vector<std::filesystem::path> folders = {});

/// Looks for a program beside the running one, in the same folder.
std::optional<std::filesystem::path> find_sibling_program(const std::string& name);

/// Runs another program in place of this one, in the same process: its exit code, signals and standard
/// streams are those of this process. `command`: path and arguments. Returns only by throwing Error
/// (kFailed).
[[noreturn]] void become_program(const std::vector<std::string>& command);

/// Returns a command as a line for a POSIX shell.
std::string shell_line(const std::vector<std::string>& command);

}  // namespace pelage
