// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <filesystem>
#include <functional>
#include <limits>
#include <string>
#include <vector>

namespace pelage {

constexpr double kNoLimit_s = std::numeric_limits<double>::infinity();

/// How a process ended, and what the kernel says it used.
struct ProcessEnd {
  int exit_code = 0;         ///< meaningless when a signal ended it
  int signal = 0;            ///< that ended it; 0: it left by itself
  bool interrupted = false;  ///< it was told to stop because `cancelled` said so
  bool timed_out = false;    ///< it was told to stop because it took longer than it may
  double wall_s = 0;
  double cpu_s = 0;  ///< user + system
  int64_t peak_rss_bytes = 0;

  bool succeeded() const { return exit_code == 0 && signal == 0 && !interrupted && !timed_out; }
};

/// Runs a program (a path, and its arguments) to its end, without input, with what it prints in the file
/// `log`.
///
/// The process stands in a group of its own. Once `cancelled` says so, or it has run for `limit_s`, it gets
/// SIGTERM and, if it has not gone a few seconds later, SIGKILL; it gets SIGKILL too when this process dies.
/// Throws Error (kFailed) when the log cannot be written or the program cannot be started.
ProcessEnd run_process(const std::vector<std::string>& command, const std::filesystem::path& log,
                       const std::function<bool()>& cancelled, double limit_s = kNoLimit_s);

/// The running program itself, as a path.
std::filesystem::path current_executable();

/// A command line as one would type it in a shell.
std::string shell_text(const std::vector<std::string>& command);

}  // namespace pelage
