// SPDX-License-Identifier: Apache-2.0
#include "cli/lab_program.h"

#include <algorithm>
#include <cstdio>
#include <ostream>

#include "base/error.h"
#include "base/program.h"

namespace pelage {
namespace {

constexpr LabCommand kCommands[] = {
    {"measure", "Run one experiment, one process per variant, and write a report: JSON, CSV, HTML"},
    {"compare", "Render a scene with every fibre model and report: contact sheet, cost, noise, energy"}};

const LabCommand* find_command(const std::string& name) {
  const auto found = std::find_if(std::begin(kCommands), std::end(kCommands),
                                  [&](const LabCommand& command) { return command.name == name; });
  return found == std::end(kCommands) ? nullptr : found;
}

bool asks_for_help(const std::vector<std::string>& arguments) {
  return std::any_of(arguments.begin(), arguments.end(),
                     [](const std::string& argument) { return argument == "--help" || argument == "-h"; });
}

/// The build links the laboratory after this program.
void warn_if_stale(const std::filesystem::path& lab) {
  std::error_code unknown;
  const auto built = std::filesystem::last_write_time(lab, unknown);
  if (unknown || built >= std::filesystem::last_write_time(current_program(), unknown) || unknown) return;
  std::fprintf(stderr, "pelage: warning: %s is older than pelage; `./dev build` builds both\n", lab.c_str());
}

}  // namespace

std::span<const LabCommand> lab_commands() { return kCommands; }

bool is_lab_command(const std::vector<std::string>& arguments) {
  return !arguments.empty() && find_command(arguments.front());
}

int start_lab(const std::filesystem::path& lab, const std::vector<std::string>& arguments,
              std::ostream& out) {
  if (find_program(lab.string())) {
    warn_if_stale(lab);
    std::vector<std::string> command{lab.string()};
    command.insert(command.end(), arguments.begin(), arguments.end());
    become_program(command);
  }
  const std::string how =
      "`" + arguments.front() + "` needs the program " + lab.filename().string() + ", which is not in " +
      lab.parent_path().string() +
      "; `./dev build` builds it and `cmake --install build/release` installs it, see docs/MEASURE.md";
  if (!asks_for_help(arguments)) throw Error(ErrorKind::kFailed, how);
  out << find_command(arguments.front())->help << "\n" << how << "\n";
  return 0;
}

}  // namespace pelage
