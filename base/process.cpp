// SPDX-License-Identifier: Apache-2.0
#include "base/process.h"

#include <algorithm>
#include <array>
#include <cerrno>
#include <chrono>
#include <cmath>
#include <csignal>
#include <cstring>
#include <system_error>
#include <utility>

#include <fcntl.h>
#include <poll.h>
#include <sys/prctl.h>
#include <sys/resource.h>
#include <sys/wait.h>
#include <unistd.h>

#include "base/error.h"

namespace pelage {
namespace {

using Clock = std::chrono::steady_clock;

[[noreturn]] void fail(const std::string& what, int error) {
  throw Error(ErrorKind::kFailed, what + ": " + std::strerror(error));
}

double seconds_since(Clock::time_point begin) {
  return std::chrono::duration<double>(Clock::now() - begin).count();
}

double seconds_of(const timeval& time) { return double(time.tv_sec) + 1e-6 * double(time.tv_usec); }

void close_if_open(int& descriptor) {
  if (descriptor >= 0) ::close(descriptor);
  descriptor = -1;
}

/// Returns a descriptor of the same file that is none of the standard streams, even if this process has
/// closed these. Closes `number`. Throws Error when the process may have no more descriptors.
int above_standard(int number) {
  if (number < 0 || number > STDERR_FILENO) return number;
  const int above = ::fcntl(number, F_DUPFD_CLOEXEC, STDERR_FILENO + 1);
  const int problem = errno;
  ::close(number);
  if (above < 0) fail("cannot duplicate a descriptor", problem);
  return above;
}

void make_pipe(int& read, int& write) {
  int ends[2];
  if (::pipe2(ends, O_CLOEXEC) != 0) fail("cannot create a pipe", errno);
  write = ends[1];  // closed by the owner if the next line throws
  read = above_standard(ends[0]);
  write = above_standard(ends[1]);
}

/// While it exists, the calling thread and the threads that it starts receive no signals.
class BlockedSignals {
 public:
  BlockedSignals() {
    sigset_t all;
    sigfillset(&all);
    ::pthread_sigmask(SIG_SETMASK, &all, &before_);
  }
  ~BlockedSignals() { ::pthread_sigmask(SIG_SETMASK, &before_, nullptr); }
  BlockedSignals(const BlockedSignals&) = delete;
  BlockedSignals& operator=(const BlockedSignals&) = delete;

 private:
  sigset_t before_;
};

/// While it exists, a write to a process that has ended fails instead of ending this process.
class NoPipeSignal {
 public:
  NoPipeSignal() {
    sigemptyset(&pipe_);
    sigaddset(&pipe_, SIGPIPE);
    ::pthread_sigmask(SIG_BLOCK, &pipe_, &before_);
  }
  ~NoPipeSignal() {
    if (sigismember(&before_, SIGPIPE)) return;
    const timespec now{};
    while (::sigtimedwait(&pipe_, nullptr, &now) > 0) {
    }
    ::pthread_sigmask(SIG_SETMASK, &before_, nullptr);
  }
  NoPipeSignal(const NoPipeSignal&) = delete;
  NoPipeSignal& operator=(const NoPipeSignal&) = delete;

 private:
  sigset_t pipe_, before_;
};

/// The environment of this process with changes, see ProcessSetup::environment.
std::vector<std::string> changed_environment(const std::vector<std::string>& changes) {
  const auto name_of = [](std::string_view variable) { return variable.substr(0, variable.find('=')); };
  const auto concerns = [&](std::string_view change, std::string_view variable) {
    const std::string_view name = name_of(change);
    return name.ends_with('*') ? variable.starts_with(name.substr(0, name.size() - 1))
                               : name == name_of(variable);
  };
  std::vector<std::string> result;
  for (char** variable = environ; *variable; ++variable) {
    if (std::none_of(changes.begin(), changes.end(),
                     [&](const std::string& change) { return concerns(change, *variable); }))
      result.emplace_back(*variable);
  }
  for (const std::string& change : changes) {
    if (change.find('=') != std::string::npos) result.push_back(change);
  }
  return result;
}

std::vector<char*> pointers(const std::vector<std::string>& words) {
  std::vector<char*> result;
  for (const std::string& word : words) result.push_back(const_cast<char*>(word.c_str()));
  result.push_back(nullptr);
  return result;
}

/// Writes as much as the pipe accepts.
void send(int& pipe, std::string_view& input) {
  const NoPipeSignal no_signal;
  const ssize_t some = ::write(pipe, input.data(), input.size());
  if (some > 0) input.remove_prefix(static_cast<size_t>(some));
  if (some >= 0 || errno == EAGAIN || errno == EINTR) return;
  input = {};
  close_if_open(pipe);
}

void receive(int& pipe, std::string& text) {
  constexpr size_t kBlock = size_t{1} << 16;
  const size_t before = text.size();
  text.resize(before + kBlock);
  const ssize_t some = ::read(pipe, text.data() + before, kBlock);
  text.resize(before + (some > 0 ? static_cast<size_t>(some) : 0));
  if (some == 0 || (some < 0 && errno != EAGAIN && errno != EINTR)) close_if_open(pipe);
}

int milliseconds(double seconds) { return static_cast<int>(std::ceil(std::clamp(seconds, 0.0, 1e6) * 1e3)); }

}  // namespace

struct Process::Launch {
  Launch() { make_pipe(failure_read, failure_write); }
  ~Launch() {
    for (int* number : {&streams[0], &streams[1], &streams[2], &failure_read, &failure_write})
      close_if_open(*number);
  }
  Launch(const Launch&) = delete;
  Launch& operator=(const Launch&) = delete;

  std::vector<std::string> environment;
  std::vector<char*> words, variables;
  std::array<int, 3> streams{-1, -1, -1};     // -1: inherited
  int failure_read = -1, failure_write = -1;  // a pipe: closed by the start of the program, or gets errno
  const pid_t parent = ::getpid();

  void open_stream(size_t stream, ProcessStream kind, int& ours) {
    if (kind == ProcessStream::kNone) {
      streams[stream] = above_standard(::open("/dev/null", O_RDWR | O_CLOEXEC));
      if (streams[stream] < 0) fail("cannot open /dev/null", errno);
    }
    if (kind != ProcessStream::kPiped) return;
    if (stream == STDIN_FILENO) {
      make_pipe(streams[stream], ours);
    } else {
      make_pipe(ours, streams[stream]);
    }
    ::fcntl(ours, F_SETFL, O_NONBLOCK);
  }

  void open_log(const std::filesystem::path& log) {
    streams[2] =
        above_standard(::open(log.c_str(), O_WRONLY | O_CREAT | O_TRUNC | O_CLOEXEC | O_NOFOLLOW, 0666));
    if (streams[2] < 0) fail(log.string() + ": cannot be written", errno);
    streams[1] = ::fcntl(streams[2], F_DUPFD_CLOEXEC, STDERR_FILENO + 1);
    if (streams[1] < 0) fail("cannot duplicate a descriptor", errno);
  }

  /// Runs in the new process, before the program: must not allocate or lock.
  [[noreturn]] void exec() const {
    ::setpgid(0, 0);
    ::prctl(PR_SET_PDEATHSIG, SIGKILL);
    bool ready = ::getppid() == parent;
    for (int stream = 0; stream < 3; ++stream) {
      const int number = streams[static_cast<size_t>(stream)];
      ready = ready && (number < 0 || ::dup2(number, stream) >= 0);
    }
    for (int number = 1; number < NSIG; ++number) {  // ours must not run here
      struct sigaction action {};
      if (::sigaction(number, nullptr, &action) == 0 && (action.sa_handler != SIG_IGN || number == SIGPIPE))
        ::signal(number, SIG_DFL);
    }
    sigset_t none;
    sigemptyset(&none);
    ::sigprocmask(SIG_SETMASK, &none, nullptr);
    if (ready) ::execve(words[0], words.data(), variables.data());
    const int code = errno;
    [[maybe_unused]] const ssize_t written = ::write(failure_write, &code, sizeof code);
    ::_exit(127);
  }
};

Process::Process(const ProcessSetup& setup) {
  Launch launch;
  launch.environment = changed_environment(setup.environment);
  launch.words = pointers(setup.command);
  launch.variables = pointers(launch.environment);
  try {
    launch.open_stream(STDIN_FILENO, setup.input, input_);
    if (setup.log.empty()) {
      launch.open_stream(STDOUT_FILENO, setup.output, output_);
      launch.open_stream(STDERR_FILENO, setup.errors, errors_);
    } else {
      launch.open_log(setup.log);
    }
    const BlockedSignals blocked;
    thread_ = std::thread([&] { run(launch); });
  } catch (const std::system_error& error) {
    close_pipes();
    fail("cannot start a thread", error.code().value());
  } catch (...) {
    close_pipes();
    throw;
  }
  {
    std::unique_lock lock(mutex_);
    changed_.wait(lock, [&] { return started_; });
  }
  if (start_error_ == 0) return;
  thread_.join();
  close_pipes();
  fail(setup.command.front() + " cannot be run", start_error_);
}

void Process::run(Launch& launch) {
  // The launch belongs to the constructor, which returns once `started_` is set.
  const Clock::time_point began = Clock::now();
  const pid_t id = ::fork();
  if (id == 0) launch.exec();
  int error = id < 0 ? errno : 0;
  close_if_open(launch.failure_write);
  if (id > 0) {
    int code = 0;
    ssize_t got = 0;
    do {
      got = ::read(launch.failure_read, &code, sizeof code);
    } while (got < 0 && errno == EINTR);
    if (got == sizeof code) {
      error = code;
      ::waitpid(id, nullptr, 0);
    }
  }
  {
    const std::lock_guard lock(mutex_);
    started_ = true;
    start_error_ = error;
    id_ = id;
    changed_.notify_all();
  }
  if (error == 0) finish(began);
}

void Process::finish(Clock::time_point began) {
  // A process that has ended keeps its number until it is waited for without WNOWAIT: until then, signals
  // reach no other process.
  siginfo_t info{};
  while (::waitid(P_PID, static_cast<id_t>(id_), &info, WEXITED | WNOWAIT) != 0 && errno == EINTR) {
  }
  const std::lock_guard lock(mutex_);
  int status = 0;
  rusage usage{};
  const bool known = ::wait4(id_, &status, 0, &usage) == id_;
  end_.wall_s = seconds_since(began);
  end_.cpu_s = seconds_of(usage.ru_utime) + seconds_of(usage.ru_stime);
  end_.peak_rss_bytes = int64_t(usage.ru_maxrss) * 1024;
  end_.exit_code = !known ? -1 : WIFEXITED(status) ? WEXITSTATUS(status) : 0;
  end_.signal = WIFSIGNALED(status) ? WTERMSIG(status) : 0;
  ended_ = true;
  changed_.notify_all();
}

Process::~Process() {
  close_pipes();
  signal(SIGKILL);
  if (thread_.joinable()) thread_.join();
}

bool Process::exchange(std::string_view& input, std::string& output, std::string& errors, double wait_s) {
  if (input_ < 0) input = {};
  if (output_ < 0 && errors_ < 0 && input.empty()) return false;
  pollfd ends[] = {{input.empty() ? -1 : input_, POLLOUT, 0}, {output_, POLLIN, 0}, {errors_, POLLIN, 0}};
  ::poll(ends, 3, milliseconds(wait_s));
  if (ends[0].revents) send(input_, input);
  if (ends[1].revents) receive(output_, output);
  if (ends[2].revents) receive(errors_, errors);
  return output_ >= 0 || errors_ >= 0;
}

void Process::close_pipes() {
  for (int* pipe : {&input_, &output_, &errors_}) close_if_open(*pipe);
}

void Process::signal(int number) {
  const std::lock_guard lock(mutex_);
  if (id_ > 0 && !ended_) ::kill(-id_, number);
}

std::optional<ProcessEnd> Process::wait(double seconds) {
  std::unique_lock lock(mutex_);
  const auto limit = std::chrono::duration<double>(std::min(seconds, 1e6));
  while (!changed_.wait_for(lock, limit, [&] { return ended_; })) {
    if (seconds < kNoLimit_s) return {};
  }
  return end_;
}

ProcessResult run_process(const ProcessSetup& setup, const ProcessLimits& limits) {
  constexpr double kPoll_s = 0.02;
  const Clock::time_point began = Clock::now();
  std::optional<Clock::time_point> told;
  ProcessResult result;
  ProcessEnd reason;
  std::string_view no_input;
  Process process(setup);
  const auto receive_some = [&](double wait_s) {
    const bool open = process.exchange(no_input, result.output, result.errors, wait_s);
    if (result.output.size() + result.errors.size() <= limits.output_bytes) return open;
    reason.output_exceeded = true;
    result.output.resize(std::min(result.output.size(), limits.output_bytes));
    result.errors.resize(std::min(result.errors.size(), limits.output_bytes - result.output.size()));
    return open;
  };
  for (;;) {
    const double poll_s = told ? kPoll_s : std::clamp(limits.seconds - seconds_since(began), 0.0, kPoll_s);
    const bool open = receive_some(poll_s);
    if (const auto end = process.wait(open ? 0 : poll_s)) {
      result.end = *end;
      break;
    }
    if (told) {
      if (seconds_since(*told) > limits.kill_delay_s) process.signal(SIGKILL);
      continue;
    }
    reason.interrupted = !reason.output_exceeded && limits.cancelled();
    reason.timed_out =
        !reason.output_exceeded && !reason.interrupted && seconds_since(began) > limits.seconds;
    if (!reason.interrupted && !reason.timed_out && !reason.output_exceeded) continue;
    process.signal(SIGTERM);
    told = Clock::now();
  }
  // What is still in the pipes. A process that was left behind may hold them open, or fill them.
  size_t before = 0;
  do {
    before = result.output.size() + result.errors.size();
  } while (receive_some(0) && result.output.size() + result.errors.size() > before &&
           !reason.output_exceeded);
  result.end.interrupted = reason.interrupted;
  result.end.timed_out = reason.timed_out;
  result.end.output_exceeded = reason.output_exceeded;
  return result;
}

}  // namespace pelage
