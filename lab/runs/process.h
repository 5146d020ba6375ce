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

/// How a process ended, and its resource usage as reported by the kernel.
struct ProcessEnd {
  int exit_code = 0;         ///< meaningless when a signal ended it
  int signal = 0;            ///< signal that ended the process; 0: it exited by itself
  bool interrupted = false;  ///< it was asked to stop because `cancelled` returned true
  bool timed_out = false;    ///< it was asked to stop because it exceeded the time limit
  double wall_s = 0;
  double cpu_s = 0;  ///< user + system
  int64_t peak_rss_bytes = 0;

  bool succeeded() const { return exit_code == 0 && signal == 0 && !interrupted && !timed_out; }
};

/// Runs a program (a path and its arguments) to its end, without input; its output goes to the file `log`.
///
/// The process is in a separate process group. Once `cancelled` returns true, or the process has run for
/// `limit_s`, it receives SIGTERM. If it has not exited a few seconds later, it receives SIGKILL. It also
/// receives SIGKILL when the calling process dies. Throws Error (kFailed) when the log cannot be written or
/// the program cannot be started.
ProcessEnd run_process(const std::vector<std::string>& command, const std::filesystem::path& log,
                       const std::function<bool()>& cancelled, double limit_s = kNoLimit_s);

/// Path of the running program.
std::filesystem::path current_executable();

/// A command line as typed in a shell.
std::string shell_text(const std::vector<std::string>& command);

}  // namespace pelage
