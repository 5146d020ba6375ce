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

/// How a process ended, and its resource usage as the kernel reports it.
struct ProcessEnd {
  int exit_code = 0;         ///< exit code; 0 if a signal ended the process
  int signal = 0;            ///< signal that ended the process; 0: the process exited by itself
  bool interrupted = false;  ///< whether it was sent SIGTERM because `cancelled` returned true
  bool timed_out = false;    ///< whether it was sent SIGTERM because it exceeded the time limit
  double wall_s = 0;
  double cpu_s = 0;  ///< user and system time
  int64_t peak_rss_bytes = 0;

  bool succeeded() const { return exit_code == 0 && signal == 0 && !interrupted && !timed_out; }
};

/// Runs a program to its end. `command` is the path of the program, followed by its arguments. The program
/// gets no input; its output goes to the file `log`.
///
/// The process runs in a process group of its own. It receives SIGTERM once `cancelled` returns true or
/// `limit_s` seconds have passed. If it has not exited a few seconds later, it receives SIGKILL. It also
/// receives SIGKILL when the calling process dies. Throws Error (kFailed) when the log cannot be written or
/// the program cannot be started.
ProcessEnd run_process(const std::vector<std::string>& command, const std::filesystem::path& log,
                       const std::function<bool()>& cancelled, double limit_s = kNoLimit_s);

/// Returns the path of the running program.
std::filesystem::path current_executable();

/// Returns a command line as one would type it in a shell.
std::string shell_text(const std::vector<std::string>& command);

}  // namespace pelage
