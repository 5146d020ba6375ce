// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cstddef>

#include <signal.h>

namespace pelage {

/// While it lives, the first SIGINT, SIGTERM or SIGHUP only raises a flag, so that a render can write what it
/// has; the second one ends the process at once. Signals that the process was started to ignore (nohup) stay
/// ignored. One at a time.
class SignalGuard {
 public:
  SignalGuard();
  ~SignalGuard();
  SignalGuard(const SignalGuard&) = delete;
  SignalGuard& operator=(const SignalGuard&) = delete;

  /// Thread safety: may be called from any thread, and is cheap.
  static bool interrupted();
  /// Exit code of a run that was interrupted: 128 and the number of the signal that the last guard saw first
  /// (130 for SIGINT, 143 for SIGTERM, 129 for SIGHUP); 130 where it saw none.
  static int exit_code();

  static constexpr std::array kHandled{SIGINT, SIGTERM, SIGHUP};

 private:
  std::array<struct sigaction, kHandled.size()> old_;
};

/// For the whole process, once, before any thread: a file that may not grow (SIGXFSZ) and a reader that has
/// left (SIGPIPE) become errors of the write that meets them, and a standard stream that is closed is opened
/// on nothing, so that no other file gets its number: what is written to a closed output fails.
void prepare_process();

}  // namespace pelage
