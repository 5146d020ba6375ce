// SPDX-License-Identifier: Apache-2.0
#include "lab/runs/process.h"

#include <cerrno>
#include <chrono>
#include <csignal>
#include <cstring>
#include <thread>

#include <fcntl.h>
#include <sys/prctl.h>
#include <sys/resource.h>
#include <sys/wait.h>
#include <unistd.h>

#include "base/error.h"

namespace pelage {
namespace {

using Clock = std::chrono::steady_clock;
constexpr auto kPoll = std::chrono::milliseconds(5);
constexpr auto kKillDelay = std::chrono::seconds(5);  // between SIGTERM and SIGKILL

double seconds_of(const timeval& time) { return double(time.tv_sec) + 1e-6 * double(time.tv_usec); }

class Descriptor {
 public:
  explicit Descriptor(int number) : number_(number) {}
  ~Descriptor() { close(); }
  Descriptor(const Descriptor&) = delete;
  Descriptor& operator=(const Descriptor&) = delete;
  int number() const { return number_; }
  void close() {
    if (number_ >= 0) ::close(number_);
    number_ = -1;
  }

 private:
  int number_;
};

// Runs in the child between fork and exec: must not allocate or lock.
[[noreturn]] void exec_child(char* const* arguments, int log, int failure, pid_t parent) {
  ::setpgid(0, 0);
  ::prctl(PR_SET_PDEATHSIG, SIGKILL);
  const int none = ::open("/dev/null", O_RDONLY);
  if (::getppid() == parent && ::dup2(none, STDIN_FILENO) >= 0 && ::dup2(log, STDOUT_FILENO) >= 0 &&
      ::dup2(log, STDERR_FILENO) >= 0) {
    ::execv(arguments[0], arguments);
  }
  const int code = errno;
  [[maybe_unused]] const ssize_t written = ::write(failure, &code, sizeof code);
  ::_exit(127);
}

ProcessEnd wait_for(pid_t child, const std::function<bool()>& cancelled, double limit_s) {
  const Clock::time_point began = Clock::now();
  Clock::time_point told;
  ProcessEnd end;
  for (;;) {
    int status = 0;
    rusage usage{};
    const pid_t gone = ::wait4(child, &status, WNOHANG, &usage);
    if (gone == child) {
      end.wall_s = std::chrono::duration<double>(Clock::now() - began).count();
      end.cpu_s = seconds_of(usage.ru_utime) + seconds_of(usage.ru_stime);
      end.peak_rss_bytes = int64_t(usage.ru_maxrss) * 1024;
      end.exit_code = WIFEXITED(status) ? WEXITSTATUS(status) : 0;
      end.signal = WIFSIGNALED(status) ? WTERMSIG(status) : 0;
      return end;
    }
    if (gone < 0 && errno != EINTR)
      throw Error(ErrorKind::kFailed, std::string("cannot wait for a process: ") + std::strerror(errno));
    const Clock::time_point now = Clock::now();
    if (end.interrupted || end.timed_out) {
      if (now - told > kKillDelay) ::kill(-child, SIGKILL);
    } else {
      end.interrupted = cancelled();
      end.timed_out = !end.interrupted && std::chrono::duration<double>(now - began).count() > limit_s;
      told = now;
      if (end.interrupted || end.timed_out) ::kill(-child, SIGTERM);
    }
    std::this_thread::sleep_for(kPoll);
  }
}

}  // namespace

ProcessEnd run_process(const std::vector<std::string>& command, const std::filesystem::path& log,
                       const std::function<bool()>& cancelled, double limit_s) {
  Descriptor log_file(::open(log.c_str(), O_WRONLY | O_CREAT | O_TRUNC | O_CLOEXEC, 0666));
  if (log_file.number() < 0)
    throw Error(ErrorKind::kFailed, log.string() + ": cannot be written: " + std::strerror(errno));
  int ends[2];
  if (::pipe2(ends, O_CLOEXEC) != 0)
    throw Error(ErrorKind::kFailed, std::string("cannot create a pipe: ") + std::strerror(errno));
  Descriptor failure_in(ends[0]), failure_out(ends[1]);

  std::vector<char*> arguments;
  for (const std::string& argument : command) arguments.push_back(const_cast<char*>(argument.c_str()));
  arguments.push_back(nullptr);
  const pid_t parent = ::getpid();
  const pid_t child = ::fork();
  if (child < 0)
    throw Error(ErrorKind::kFailed, std::string("cannot create a process: ") + std::strerror(errno));
  if (child == 0) exec_child(arguments.data(), log_file.number(), failure_out.number(), parent);
  ::setpgid(child, child);  // by whichever process is first

  failure_out.close();
  int code = 0;
  ssize_t got = 0;
  do {
    got = ::read(failure_in.number(), &code, sizeof code);
  } while (got < 0 && errno == EINTR);
  const ProcessEnd end = wait_for(child, cancelled, limit_s);
  if (got == sizeof code)
    throw Error(ErrorKind::kFailed, command.front() + " cannot be run: " + std::strerror(code));
  return end;
}

std::filesystem::path current_executable() { return std::filesystem::read_symlink("/proc/self/exe"); }

std::string shell_text(const std::vector<std::string>& command) {
  std::string text;
  for (const std::string& word : command) {
    const bool plain = !word.empty() && word.find_first_not_of(
                                            "abcdefghijklmnopqrstuvwxyzABCDEFGHIJKLMNOPQRSTUVWXYZ"
                                            "0123456789_-+=./:,%@") == std::string::npos;
    std::string quoted = word;
    if (!plain) {
      quoted = "'";
      for (const char c : word) quoted += c == '\'' ? std::string("'\\''") : std::string(1, c);
      quoted += "'";
    }
    text += (text.empty() ? "" : " ") + quoted;
  }
  return text;
}

}  // namespace pelage
