// SPDX-License-Identifier: Apache-2.0
#include "cli/argument_errors.h"

#include <string>
#include <vector>

#include <CLI/App.hpp>

#include "base/error.h"
#include "base/nearest_name.h"

namespace pelage {
namespace {

std::vector<std::string> flag_names(const CLI::App& app) {
  std::vector<std::string> names;
  for (const CLI::Option* option : app.get_options()) {
    for (const std::string& name : option->get_lnames()) names.push_back("--" + name);
  }
  return names;
}

/// Returns the name as it is typed: "pelage", "pelage render".
std::string command_name(const CLI::App& app) {
  return app.get_parent() ? app.get_parent()->get_name() + " " + app.get_name() : app.get_name();
}

}  // namespace

void fail_arguments(const std::string& message) { throw Error(ErrorKind::kArguments, message); }

void fail_extras(const CLI::App& app) {
  for (const std::string& extra : app.remaining(true)) {
    if (!extra.starts_with("-")) fail_arguments("unexpected argument " + quote(extra));
    const std::string flag = extra.substr(0, extra.find('='));
    const std::vector<std::string> names = flag_names(app);
    const std::string near = did_you_mean(flag, names);
    fail_arguments("unknown option " + quote(flag) +
                   (near.empty() ? "; see '" + command_name(app) + " --help'" : near));
  }
  fail_arguments("cannot parse the arguments; see 'pelage --help'");
}

void check_file_names(const CLI::App& app) {
  for (const char* name : {"--output", "--stats"}) {
    const CLI::Option* option = app.get_option_no_throw(name);
    if (!option || option->count() == 0 || !option->results().back().empty()) continue;
    fail_arguments(std::string(option->check_name("-o") ? "-o" : name) +
                   ": expected a name, got an empty one");
  }
}

}  // namespace pelage
