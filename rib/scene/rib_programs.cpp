// SPDX-License-Identifier: Apache-2.0
#include "rib/scene/rib_programs.h"

#include <algorithm>
#include <cerrno>
#include <chrono>
#include <csignal>
#include <cstring>
#include <thread>

#include <fcntl.h>
#include <fmt/format.h>
#include <poll.h>
#include <sys/prctl.h>
#include <sys/wait.h>
#include <unistd.h>

#include "base/error.h"
#include "base/nearest_name.h"

namespace pelage {
namespace {

using Clock = std::chrono::steady_clock;
constexpr int kPoll_ms = 100;
constexpr int kGrace_ms = 500;  // for a program to end after its input has ended
constexpr char kEndOfReply = '\377';

[[noreturn]] void fail(const std::string& message) { throw Error(ErrorKind::kInput, message); }

std::vector<std::string> command_words(const std::string& command) {
  std::vector<std::string> words;
  for (size_t at = command.find_first_not_of(' '); at != std::string::npos;) {
    const size_t end = std::min(command.find(' ', at), command.size());
    words.push_back(command.substr(at, end - at));
    at = command.find_first_not_of(' ', end);
  }
  return words;
}

std::filesystem::path find_program(const std::string& name, std::vector<std::filesystem::path> folders) {
  const std::filesystem::path file(name);
  if (file.is_absolute()) folders = {""};
  if (const char* path = std::getenv("PATH"); path && name.find('/') == std::string::npos) {
    for (const std::string& part : command_words([&] {
           std::string text = path;
           std::replace(text.begin(), text.end(), ':', ' ');
           return text;
         }()))
      folders.emplace_back(part);
  }
  for (const std::filesystem::path& folder : folders) {
    const std::filesystem::path program = folder / file;
    std::error_code ignored;
    if (std::filesystem::is_regular_file(program, ignored) && ::access(program.c_str(), X_OK) == 0)
      return std::filesystem::absolute(program);
  }
  fail("there is no program " + quote(name) + " beside the file, on the search path, or on PATH");
}

/// Between fork and exec: must not allocate or lock.
[[noreturn]] void exec_child(const char* path, char* const* arguments, int input, int output, pid_t parent) {
  ::setpgid(0, 0);
  ::prctl(PR_SET_PDEATHSIG, SIGKILL);
  sigset_t none;
  sigemptyset(&none);
  ::sigprocmask(SIG_SETMASK, &none, nullptr);
  ::signal(SIGPIPE, SIG_DFL);
  if (::getppid() == parent && ::dup2(input, STDIN_FILENO) >= 0 && ::dup2(output, STDOUT_FILENO) >= 0)
    ::execv(path, arguments);
  ::_exit(127);
}

void close_if_open(int& descriptor) {
  if (descriptor >= 0) ::close(descriptor);
  descriptor = -1;
}

/// A write to a program that has ended must fail, not end this process.
class NoPipeSignal {
 public:
  NoPipeSignal() {
    sigemptyset(&pipe_);
    sigaddset(&pipe_, SIGPIPE);
    ::pthread_sigmask(SIG_BLOCK, &pipe_, &before_);
  }
  ~NoPipeSignal() {
    if (!sigismember(&before_, SIGPIPE)) {
      const timespec now{};
      while (::sigtimedwait(&pipe_, nullptr, &now) > 0) {
      }
    }
    ::pthread_sigmask(SIG_SETMASK, &before_, nullptr);
  }
  NoPipeSignal(const NoPipeSignal&) = delete;
  NoPipeSignal& operator=(const NoPipeSignal&) = delete;

 private:
  sigset_t pipe_, before_;
};

}  // namespace

RibReply::~RibReply() {
  std::error_code ignored;
  std::filesystem::remove(path_, ignored);
}

/// A running program.
class RibPrograms::Program {
 public:
  Program(const std::filesystem::path& path, const std::vector<std::string>& words, StarterThread& starter) {
    std::vector<char*> arguments;
    for (const std::string& word : words) arguments.push_back(const_cast<char*>(word.c_str()));
    arguments.push_back(nullptr);
    int in[2] = {-1, -1}, out[2] = {-1, -1};
    if (::pipe2(in, O_CLOEXEC) != 0 || ::pipe2(out, O_CLOEXEC) != 0) {
      for (int* end : {&in[0], &in[1], &out[0], &out[1]}) close_if_open(*end);
      fail("cannot create a pipe: " + std::string(std::strerror(errno)));
    }
    const pid_t parent = ::getpid();
    starter.run([&] {
      child_ = ::fork();
      if (child_ == 0) exec_child(path.c_str(), arguments.data(), in[0], out[1], parent);
    });
    ::close(in[0]);
    ::close(out[1]);
    to_ = in[1];
    from_ = out[0];
    if (child_ < 0) {
      end();
      fail("cannot create a process: " + std::string(std::strerror(errno)));
    }
    ::setpgid(child_, child_);  // by whichever process is first
    ::fcntl(to_, F_SETFL, O_NONBLOCK);
    ::fcntl(from_, F_SETFL, O_NONBLOCK);
  }
  ~Program() { end(); }
  Program(const Program&) = delete;
  Program& operator=(const Program&) = delete;

  /// Sends a line, and passes the reply to `use`, piece by piece.
  void ask(const std::string& line, const RibProgramLimits& limits, const std::function<void()>& check_stop,
           const std::function<void(std::string_view)>& use) {
    const NoPipeSignal no_signal;
    const Clock::time_point began = Clock::now();
    size_t sent = 0, bytes = 0;
    std::vector<char> block(1 << 16);
    for (;;) {
      if (const size_t end = ahead_.find(kEndOfReply); end != std::string::npos) {
        use(std::string_view(ahead_).substr(0, end));
        ahead_.erase(0, end + 1);
        return;
      }
      use(ahead_);
      bytes += ahead_.size();
      ahead_.clear();
      if (bytes > limits.reply_bytes)
        fail(fmt::format("its reply has more than {} bytes", limits.reply_bytes));
      if (check_stop) check_stop();
      if (std::chrono::duration<double>(Clock::now() - began).count() > limits.reply_s)
        fail(fmt::format("it did not end its reply within {:.3g} seconds", limits.reply_s));
      pollfd ends[2] = {{from_, POLLIN, 0}, {to_, POLLOUT, 0}};
      ::poll(ends, sent < line.size() ? 2 : 1, kPoll_ms);
      // A program that does not read its input may still answer.
      if (sent < line.size() && (ends[1].revents & POLLOUT)) {
        const ssize_t some = ::write(to_, line.data() + sent, line.size() - sent);
        if (some > 0) sent += static_cast<size_t>(some);
        if (some < 0 && errno == EPIPE) sent = line.size();
      }
      const ssize_t got = ::read(from_, block.data(), block.size());
      if (got > 0) ahead_.assign(block.data(), static_cast<size_t>(got));
      if (got == 0) fail(end_text());
    }
  }

 private:
  std::string end_text() {
    const int status = end();
    const std::string how = WIFSIGNALED(status) ? fmt::format("by signal {}", WTERMSIG(status))
                                                : fmt::format("with exit code {}", WEXITSTATUS(status));
    return "it ended " + how + " before it ended its reply with a byte 255";
  }

  /// Ends the process. Returns its status.
  int end() {
    close_if_open(to_);
    close_if_open(from_);
    if (child_ <= 0) return 0;
    int status = 0;
    for (int waited = 0;; ++waited) {
      const pid_t gone = ::waitpid(child_, &status, waited < kGrace_ms ? WNOHANG : 0);
      if (gone == child_ || (gone < 0 && errno != EINTR)) break;
      if (waited == kGrace_ms - 1) ::kill(-child_, SIGKILL);
      std::this_thread::sleep_for(std::chrono::milliseconds(1));
    }
    child_ = -1;
    return status;
  }

  pid_t child_ = -1;
  int to_ = -1, from_ = -1;
  std::string ahead_;  // what was read but belongs to the rest of the reply, or to the next one
};

RibPrograms::RibPrograms(const RibProgramLimits& limits) : limits_(limits) {}
RibPrograms::~RibPrograms() = default;

RibPrograms::Program& RibPrograms::program(const std::string& command,
                                           const std::vector<std::filesystem::path>& folders) {
  std::unique_ptr<Program>& known = programs_[command];
  if (known) return *known;
  const std::vector<std::string> words = command_words(command);
  if (words.empty()) fail("expected the name of a program");
  const std::filesystem::path path = find_program(words[0], folders);
  if (!starter_) starter_.emplace();
  known = std::make_unique<Program>(path, words, *starter_);
  return *known;
}

void RibPrograms::keep(std::shared_ptr<const RibReply> reply, size_t bytes) {
  kept_.emplace_back(std::move(reply), bytes);
  kept_bytes_ += bytes;
  while (kept_bytes_ > limits_.kept_bytes && kept_.size() > 1) {
    kept_bytes_ -= kept_.front().second;
    kept_.pop_front();
  }
}

std::shared_ptr<const RibReply> RibPrograms::ask(const std::string& command,
                                                 const std::vector<std::filesystem::path>& folders,
                                                 const std::string& request,
                                                 const std::function<void()>& check_stop) {
  const std::lock_guard lock(mutex_);
  std::weak_ptr<const RibReply>& known = replies_[{command, request}];
  if (std::shared_ptr<const RibReply> reply = known.lock()) return reply;
  if (request.find_first_of(std::string_view("\n\0", 2)) != std::string::npos)
    fail("the arguments contain a line break");
  if (count_ >= limits_.requests)
    fail(fmt::format("the programs of this scene were asked more than {} times", limits_.requests));
  Program& asked = program(command, folders);
  if (!folder_) folder_ = std::make_shared<const TemporaryFolder>();
  auto reply = std::make_shared<const RibReply>(folder_->path() / fmt::format("{}.rib", ++count_), folder_);
  const auto close = [](std::FILE* file) { std::fclose(file); };
  const std::unique_ptr<std::FILE, decltype(close)> file(std::fopen(reply->path().c_str(), "wbe"), close);
  size_t bytes = 0;
  const auto cannot_write = [&] {
    throw Error(ErrorKind::kFailed, reply->path().string() + ": cannot be written: " + std::strerror(errno));
  };
  if (!file) cannot_write();
  try {
    asked.ask(request + "\n", limits_, check_stop, [&](std::string_view piece) {
      if (std::fwrite(piece.data(), 1, piece.size(), file.get()) != piece.size()) cannot_write();
      bytes += piece.size();
      all_bytes_ += piece.size();
      if (all_bytes_ > limits_.all_bytes)
        fail(fmt::format("all replies together have more than {} bytes", limits_.all_bytes));
    });
    if (std::fflush(file.get()) != 0) cannot_write();
  } catch (...) {
    programs_.erase(command);  // it may be in the middle of a reply
    throw;
  }
  known = reply;
  keep(reply, bytes);
  return reply;
}

}  // namespace pelage
