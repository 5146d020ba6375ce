// SPDX-License-Identifier: Apache-2.0
#include "cli/signals.h"

#include <atomic>
#include <cstdint>
#include <string_view>

#include <fcntl.h>
#include <time.h>
#include <unistd.h>

namespace pelage {
namespace {

// A signal handler can access only statics.
std::atomic<int> g_signal{0};  // the first one; 0: none yet
std::atomic<int64_t> g_heard_ms{0};
std::atomic<uint32_t> g_checkpoints{0};
std::string_view g_note;  // changes only while no handler is installed
static_assert(std::atomic<int>::is_always_lock_free && std::atomic<int64_t>::is_always_lock_free &&
              std::atomic<uint32_t>::is_always_lock_free);

int64_t now_ms() {
  timespec now{};
  ::clock_gettime(CLOCK_MONOTONIC, &now);
  return int64_t{now.tv_sec} * 1000 + now.tv_nsec / 1'000'000;
}

/// timeout(1) and batch systems send SIGTERM or SIGHUP to a process and to its group: this counts as one
/// request.
constexpr int64_t kOneRequest_ms = 1000;

void on_signal(int signal) {
  int none = 0;
  if (g_signal.compare_exchange_strong(none, signal)) {
    g_heard_ms.store(now_ms());
    [[maybe_unused]] const ssize_t written = ::write(STDERR_FILENO, g_note.data(), g_note.size());
    return;
  }
  if (signal != SIGINT && signal == g_signal.load() && now_ms() - g_heard_ms.load() < kOneRequest_ms) return;
  ::signal(signal, SIG_DFL);
  ::raise(signal);  // ends the process when this handler returns
}

struct sigaction install(int signal) {
  struct sigaction old {};
  ::sigaction(signal, nullptr, &old);
  if (old.sa_handler == SIG_IGN) return old;
  struct sigaction action {};
  action.sa_handler = on_signal;
  action.sa_flags = SA_RESTART;
  ::sigemptyset(&action.sa_mask);
  ::sigaction(signal, &action, nullptr);
  return old;
}

}  // namespace

SignalGuard::SignalGuard(std::string_view note) {
  g_note = note;
  g_signal.store(0);
  for (size_t i = 0; i < kHandled.size(); ++i) old_[i] = install(kHandled[i]);
}

SignalGuard::~SignalGuard() {
  for (size_t i = 0; i < kHandled.size(); ++i) ::sigaction(kHandled[i], &old_[i], nullptr);
}

bool SignalGuard::interrupted() { return g_signal.load(std::memory_order_relaxed) != 0; }

int SignalGuard::exit_code() {
  const int signal = g_signal.load();
  return 128 + (signal != 0 ? signal : SIGINT);
}

bool SignalGuard::from_outside() {
  const int signal = g_signal.load();
  return signal == SIGTERM || signal == SIGHUP;
}

CheckpointSignal::CheckpointSignal() {
  struct sigaction action {};
  action.sa_handler = [](int) { g_checkpoints.fetch_add(1, std::memory_order_relaxed); };
  action.sa_flags = SA_RESTART;
  ::sigemptyset(&action.sa_mask);
  ::sigaction(SIGUSR1, &action, &old_);
}

CheckpointSignal::~CheckpointSignal() { ::sigaction(SIGUSR1, &old_, nullptr); }

uint32_t CheckpointSignal::count() { return g_checkpoints.load(std::memory_order_relaxed); }

void prepare_process() {
  ::signal(SIGXFSZ, SIG_IGN);
  ::signal(SIGPIPE, SIG_IGN);
  for (const int stream : {STDIN_FILENO, STDOUT_FILENO, STDERR_FILENO}) {
    if (::fcntl(stream, F_GETFD) >= 0) continue;
    // open() returns the lowest free descriptor, which is the number of the closed stream. Messages to a
    // closed standard error are discarded; output was requested, so writing it must fail.
    [[maybe_unused]] const int opened = ::open("/dev/null", stream == STDERR_FILENO ? O_WRONLY : O_RDONLY);
  }
}

}  // namespace pelage
