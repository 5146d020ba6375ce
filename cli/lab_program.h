// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>
#include <iosfwd>
#include <span>
#include <string>
#include <vector>

namespace pelage {

/// A command that the laboratory has: the program pelage-lab, which is a program of its own, so that building
/// and starting `pelage` does without it.
struct LabCommand {
  const char* name;
  const char* help;
};
std::span<const LabCommand> lab_commands();

/// Whether a command line of `pelage` is one of the laboratory.
bool is_lab_command(const std::vector<std::string>& arguments);

/// Runs `lab`, the path of the laboratory, in place of this program, with the same arguments. If `lab` cannot
/// be run: for --help, writes what the command does and how to get the laboratory to `out`, and returns 0;
/// otherwise throws Error (kFailed) that says how to get it.
int start_lab(const std::filesystem::path& lab, const std::vector<std::string>& arguments, std::ostream& out);

}  // namespace pelage
