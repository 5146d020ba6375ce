// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cstddef>

#include <signal.h>

namespace pelage {

/// During its lifetime, the first SIGINT, SIGTERM or SIGHUP only sets a flag, so that a render can write a
/// partial result. The second signal ends the process at once. Signals that were ignored when the process was
/// started (nohup) stay ignored. Only one at a time.
class SignalGuard {
 public:
  SignalGuard();
  ~SignalGuard();
  SignalGuard(const SignalGuard&) = delete;
  SignalGuard& operator=(const SignalGuard&) = delete;

  /// Thread safety: may be called from any thread, and is cheap.
  static bool interrupted();
  /// Exit code of an interrupted run: 128 plus the number of the first signal that the last guard received
  /// (130 for SIGINT, 143 for SIGTERM, 129 for SIGHUP); 130 if it received none.
  static int exit_code();

  static constexpr std::array kHandled{SIGINT, SIGTERM, SIGHUP};

 private:
  std::array<struct sigaction, kHandled.size()> old_;
};

/// Call once per process, before starting threads. Makes writing beyond a file size limit (SIGXFSZ) and to a
/// closed pipe (SIGPIPE) an error of that write. Opens closed standard streams on /dev/null, so that no other
/// file gets their descriptors. Writing to a closed output then fails.
void prepare_process();

}  // namespace pelage
