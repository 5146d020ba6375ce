// SPDX-License-Identifier: Apache-2.0
#include "cli/signals.h"

#include <atomic>
#include <string_view>

#include <unistd.h>

namespace pelage {
namespace {

// A signal handler can reach nothing but statics.
std::atomic<bool> g_interrupted{false};
static_assert(std::atomic<bool>::is_always_lock_free);

void on_signal(int) {
  g_interrupted.store(true, std::memory_order_relaxed);
  constexpr std::string_view kNote = "\npelage: stopping; once more ends at once\n";
  [[maybe_unused]] const ssize_t written = ::write(STDERR_FILENO, kNote.data(), kNote.size());
}

struct sigaction install(int signal) {
  struct sigaction action {};
  action.sa_handler = on_signal;
  // The handler is gone after the first signal: the second one has its default effect.
  action.sa_flags = static_cast<int>(SA_RESETHAND) | SA_RESTART;
  ::sigemptyset(&action.sa_mask);
  struct sigaction old {};
  ::sigaction(signal, &action, &old);
  return old;
}

}  // namespace

SignalGuard::SignalGuard() {
  g_interrupted.store(false, std::memory_order_relaxed);
  old_interrupt_ = install(SIGINT);
  old_terminate_ = install(SIGTERM);
}

SignalGuard::~SignalGuard() {
  ::sigaction(SIGINT, &old_interrupt_, nullptr);
  ::sigaction(SIGTERM, &old_terminate_, nullptr);
}

bool SignalGuard::interrupted() { return g_interrupted.load(std::memory_order_relaxed); }

}  // namespace pelage
