// SPDX-License-Identifier: Apache-2.0
#include "base/program.h"

#include <algorithm>
#include <cerrno>
#include <cstdlib>
#include <cstring>
#include <string_view>

#include <unistd.h>

#include "base/error.h"

namespace pelage {

namespace fs = std::filesystem;

fs::path current_program() { return fs::read_symlink("/proc/self/exe"); }

std::optional<fs::path> find_program(const std::string& name, std::vector<fs::path> folders) {
  if (fs::path(name).is_absolute()) folders = {""};
  if (const char* path = std::getenv("PATH"); path && name.find('/') == std::string::npos) {
    const std::string_view list(path);
    for (size_t at = 0; at <= list.size();) {
      const size_t end = std::min(list.find(':', at), list.size());
      folders.emplace_back(list.substr(at, end - at));
      at = end + 1;
    }
  }
  for (const fs::path& folder : folders) {
    const fs::path program = folder / name;
    std::error_code ignored;
    if (fs::is_regular_file(program, ignored) && ::access(program.c_str(), X_OK) == 0)
      return fs::absolute(program);
  }
  return {};
}

std::optional<fs::path> find_sibling_program(const std::string& name) {
  return find_program((current_program().parent_path() / name).string());
}

void become_program(const std::vector<std::string>& command) {
  std::vector<char*> arguments;
  for (const std::string& word : command) arguments.push_back(const_cast<char*>(word.c_str()));
  arguments.push_back(nullptr);
  ::execv(arguments[0], arguments.data());
  throw Error(ErrorKind::kFailed, command.front() + " cannot be run: " + std::strerror(errno));
}

std::string shell_line(const std::vector<std::string>& command) {
  constexpr std::string_view kPlain =
      "abcdefghijklmnopqrstuvwxyzABCDEFGHIJKLMNOPQRSTUVWXYZ0123456789_-./,:=@%+";
  std::string line;
  for (const std::string& word : command) {
    if (!line.empty()) line += ' ';
    if (!word.empty() && word.find_first_not_of(kPlain) == std::string::npos) {
      line += word;
      continue;
    }
    line += '\'';
    for (const char c : word) line += c == '\'' ? std::string("'\\''") : std::string(1, c);
    line += '\'';
  }
  return line;
}

}  // namespace pelage
