// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <chrono>
#include <condition_variable>
#include <cstdint>
#include <filesystem>
#include <functional>
#include <limits>
#include <mutex>
#include <optional>
#include <string>
#include <string_view>
#include <thread>
#include <vector>

#include <sys/types.h>

namespace pelage {

/// What a process has as one of its standard streams.
enum class ProcessStream {
  kNone,       ///< /dev/null
  kInherited,  ///< the stream of this process
  kPiped,      ///< sent or received by Process::exchange()
};

/// How to start a process.
struct ProcessSetup {
  std::vector<std::string> command;  ///< path of the program, and its arguments
  ProcessStream input = ProcessStream::kNone;
  ProcessStream output = ProcessStream::kPiped, errors = ProcessStream::kPiped;
  /// Unless empty: the file for output and errors, in place of the above. It must not be a symbolic link.
  std::filesystem::path log = {};
  /// What differs from the environment of this process: "NAME=value" sets a variable, "NAME" removes it,
  /// "PREFIX*" removes all whose names start with the prefix.
  std::vector<std::string> environment = {};
};

/// How a process ended, and its resource usage as the kernel reports it.
struct ProcessEnd {
  /// 0 if a signal ended the process; -1: unknown, because the host of this code ignores SIGCHLD.
  int exit_code = 0;
  int signal = 0;  ///< signal that ended the process; 0: the process exited by itself
  double wall_s = 0;
  double cpu_s = 0;  ///< user and system time, with the processes that it waited for
  int64_t peak_rss_bytes = 0;

  // Set by run_process(): why it sent SIGTERM.
  bool interrupted = false;      ///< because `cancelled` returned true
  bool timed_out = false;        ///< because the process exceeded the time limit
  bool output_exceeded = false;  ///< because the process exceeded the limit of its output

  bool succeeded() const {
    return exit_code == 0 && signal == 0 && !interrupted && !timed_out && !output_exceeded;
  }
};

/// A running program. It leads a process group of its own, in which the processes that it starts are, too. A
/// thread per object starts the program and waits for its end, because the system ends a process when the
/// thread that started it ends. So the program runs until its end or that of this object or process,
/// whichever thread made the object.
///
/// Thread safety: signal() and wait() may be called from any thread, the other members from one at a time.
class Process {
 public:
  /// Starts the program. Throws Error (kFailed) if the program cannot be run or the log cannot be written.
  explicit Process(const ProcessSetup& setup);
  /// Ends the group with SIGKILL if the program is still running.
  ~Process();
  Process(const Process&) = delete;
  Process& operator=(const Process&) = delete;

  /// Sends the start of `input` through the pipe, as far as the program accepts it, and removes this part;
  /// all of `input` if the program no longer reads. Appends what has arrived from the other pipes. Waits at
  /// most `wait_s` seconds until there is something to do. Returns false once the pipes of output and errors
  /// have ended, or if there are none.
  bool exchange(std::string_view& input, std::string& output, std::string& errors, double wait_s);
  /// Closes all pipes: the program reads the end of its input, and can write nothing more.
  void close_pipes();

  /// Sends a signal to the group. Does nothing once the program has ended.
  void signal(int number);
  /// Waits at most `seconds` for the end of the program. Returns nothing if it is still running.
  std::optional<ProcessEnd> wait(double seconds);

 private:
  struct Launch;  // what the new process needs
  void run(Launch& launch);
  void finish(std::chrono::steady_clock::time_point began);

  int input_ = -1, output_ = -1, errors_ = -1;  // our ends of the pipes

  std::mutex mutex_;  // guards the following
  std::condition_variable changed_;
  bool started_ = false, ended_ = false;
  int start_error_ = 0;  // value of errno
  pid_t id_ = -1;
  ProcessEnd end_;
  std::thread thread_;
};

inline constexpr double kNoLimit_s = std::numeric_limits<double>::infinity();

struct ProcessLimits {
  double seconds = kNoLimit_s;
  double kill_delay_s = 5;                 ///< between SIGTERM and SIGKILL
  size_t output_bytes = size_t{64} << 20;  ///< of output and errors together
  std::function<bool()> cancelled = [] { return false; };
};

struct ProcessResult {
  ProcessEnd end;
  std::string output, errors;  ///< what was piped, at most ProcessLimits::output_bytes together
};

/// Runs a program to its end, without input. It receives SIGTERM when it exceeds a limit or is cancelled, and
/// SIGKILL if it does not end in time. Does not wait for processes that the program leaves
/// behind. Throws the errors of Process.
ProcessResult run_process(const ProcessSetup& setup, const ProcessLimits& limits = {});

}  // namespace pelage
