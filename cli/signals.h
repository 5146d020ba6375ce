// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <signal.h>

namespace pelage {

/// Exit code of a run that was interrupted and left a valid partial file.
constexpr int kInterruptedExitCode = 130;

/// While it lives, the first SIGINT or SIGTERM only raises a flag, so that a render can write what it has;
/// the second one ends the process at once. One at a time.
class SignalGuard {
 public:
  SignalGuard();
  ~SignalGuard();
  SignalGuard(const SignalGuard&) = delete;
  SignalGuard& operator=(const SignalGuard&) = delete;

  /// Thread safety: may be called from any thread, and is cheap.
  static bool interrupted();

 private:
  struct sigaction old_interrupt_;
  struct sigaction old_terminate_;
};

}  // namespace pelage
