// SPDX-License-Identifier: Apache-2.0
#include "rib/scene/rib_programs.h"

#include <algorithm>
#include <cerrno>
#include <chrono>
#include <cstdio>
#include <cstring>

#include <fmt/format.h>

#include "base/error.h"
#include "base/nearest_name.h"
#include "base/process.h"
#include "base/program.h"

namespace pelage {
namespace {

using Clock = std::chrono::steady_clock;
constexpr double kPoll_s = 0.1;
constexpr double kGrace_s = 0.5;  // for a program to end after its input has ended
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

}  // namespace

RibReply::~RibReply() {
  std::error_code ignored;
  std::filesystem::remove(path_, ignored);
}

/// A running program. Its error messages are those of this process.
class RibPrograms::Program {
 public:
  explicit Program(const std::vector<std::string>& command)
      : process_({command, ProcessStream::kPiped, ProcessStream::kPiped, ProcessStream::kInherited}) {}
  ~Program() { end(); }
  Program(const Program&) = delete;
  Program& operator=(const Program&) = delete;

  /// Sends a line, and passes the reply to `use`, piece by piece.
  void ask(std::string_view line, const RibProgramLimits& limits, const std::function<void()>& check_stop,
           const std::function<void(std::string_view)>& use) {
    const Clock::time_point began = Clock::now();
    size_t bytes = 0;
    for (bool open = true;;) {
      if (const size_t end = ahead_.find(kEndOfReply); end != std::string::npos) {
        use(std::string_view(ahead_).substr(0, end));
        ahead_.erase(0, end + 1);
        return;
      }
      if (!open) fail(end_text());
      use(ahead_);
      bytes += ahead_.size();
      ahead_.clear();
      if (bytes > limits.reply_bytes)
        fail(fmt::format("its reply has more than {} bytes", limits.reply_bytes));
      if (check_stop) check_stop();
      if (std::chrono::duration<double>(Clock::now() - began).count() > limits.reply_s)
        fail(fmt::format("it did not end its reply within {:.3g} seconds", limits.reply_s));
      std::string no_errors;
      open = process_.exchange(line, ahead_, no_errors, kPoll_s);
    }
  }

 private:
  /// Lets the program end by itself, for a moment. Returns nothing if it does not.
  std::optional<ProcessEnd> end() {
    process_.close_pipes();
    return process_.wait(kGrace_s);
  }

  std::string end_text() {
    const std::optional<ProcessEnd> end = this->end();
    const std::string how = !end               ? "its output"
                            : end->signal != 0 ? fmt::format("by signal {}", end->signal)
                                               : fmt::format("with exit code {}", end->exit_code);
    return "it ended " + how + " before it ended its reply with a byte 255";
  }

  Process process_;
  std::string ahead_;  // what was read but belongs to the rest of the reply, or to the next one
};

RibPrograms::RibPrograms(const RibProgramLimits& limits) : limits_(limits) {}
RibPrograms::~RibPrograms() = default;

RibPrograms::Program& RibPrograms::program(const std::string& command,
                                           const std::vector<std::filesystem::path>& folders) {
  std::unique_ptr<Program>& known = programs_[command];
  if (known) return *known;
  std::vector<std::string> words = command_words(command);
  if (words.empty()) fail("expected the name of a program");
  const auto path = find_program(words[0], folders);
  if (!path) {
    fail("there is no program " + quote(words[0]) + " beside the file, on the search path, or on PATH");
  }
  words[0] = path->string();
  try {
    known = std::make_unique<Program>(words);
  } catch (const Error& error) {
    fail(error.problems().front().message);
  }
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
