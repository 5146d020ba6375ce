// SPDX-License-Identifier: Apache-2.0
#include "cli/command_line.h"

#include <algorithm>
#include <ostream>

#include <CLI/App.hpp>
#include <CLI/Config.hpp>
#include <CLI/Formatter.hpp>

#include "base/error.h"
#include "base/nearest_name.h"
#include "base/version.h"

namespace pelage {
namespace {

std::vector<std::string> flag_names(const CLI::App& app) {
  std::vector<std::string> names;
  for (const CLI::Option* option : app.get_options()) {
    for (const std::string& name : option->get_lnames()) names.push_back("--" + name);
  }
  return names;
}

/// "; see 'pelage render --help'"
std::string see_help(const CLI::App& app) {
  const std::string before = app.get_parent() ? app.get_parent()->get_name() + " " : "";
  return "; see '" + before + app.get_name() + " --help'";
}

/// Fails because of an argument that `app` does not know. Suggests the nearest known one.
[[noreturn]] void fail_extras(const CLI::App& app) {
  for (const std::string& extra : app.remaining(true)) {
    if (!extra.starts_with("-")) fail_arguments("unexpected argument " + quote(extra));
    const std::string flag = extra.substr(0, extra.find('='));
    const std::string near = did_you_mean(flag, flag_names(app));
    fail_arguments("unknown option " + quote(flag) + (near.empty() ? see_help(app) : near));
  }
  fail_arguments("cannot parse the arguments" + see_help(app));
}

void check_file_names(const CLI::App& app) {
  for (const char* name : {"--output", "--stats"}) {
    const CLI::Option* option = app.get_option_no_throw(name);
    if (!option || option->count() == 0 || !option->results().back().empty()) continue;
    fail_arguments(std::string(option->check_name("-o") ? "-o" : name) +
                   ": expected a name, got an empty one");
  }
}

/// Returns the command that the first argument names; `app` itself if that is a flag. Otherwise an unknown
/// first word would be reported as a superfluous argument.
const CLI::App* chosen_command(const CLI::App& app, const std::vector<std::string>& arguments) {
  if (arguments.empty()) fail_arguments("expected a command" + see_help(app));
  if (arguments[0].starts_with("-")) return &app;
  std::vector<std::string> names;
  for (const CLI::App* command : app.get_subcommands({})) {
    if (command->get_name() == arguments[0]) return command;
    names.push_back(command->get_name());
  }
  std::sort(names.begin(), names.end());
  std::string hint = did_you_mean(arguments[0], names);
  for (const std::string& name : hint.empty() ? names : std::vector<std::string>())
    hint += (hint.empty() ? "; expected one of " : ", ") + name;
  fail_arguments("unknown command " + quote(arguments[0]) + hint);
}

}  // namespace

void fail_arguments(const std::string& message) { throw Error(ErrorKind::kArguments, message); }

std::unique_ptr<CLI::App> make_parser(const std::string& description, const std::string& program,
                                      const std::string& footer) {
  auto app = std::make_unique<CLI::App>(description, program);
  app->set_version_flag("--version", program + " " + std::string(version()), "Print the version and exit");
  app->require_subcommand(1);
  app->footer(footer);
  return app;
}

bool parse_command_line(CLI::App& app, const std::vector<std::string>& arguments, std::ostream& out) {
  const CLI::App* chosen = chosen_command(app, arguments);
  try {
    app.parse(std::vector<std::string>(arguments.rbegin(), arguments.rend()));
  } catch (const CLI::CallForHelp&) {
    out << chosen->help(chosen == &app ? "" : app.get_name());
    return false;
  } catch (const CLI::CallForVersion&) {
    out << app.get_name() << " " << version() << "\n";
    return false;
  } catch (const CLI::ExtrasError&) {
    fail_extras(*chosen);
  } catch (const CLI::ParseError& error) {
    if (chosen == &app && app.remaining_size() > 0) fail_extras(app);
    std::string message = error.what();
    std::replace(message.begin(), message.end(), '\n', ' ');
    fail_arguments(message + see_help(*chosen));
  }
  check_file_names(*chosen);
  return true;
}

}  // namespace pelage
