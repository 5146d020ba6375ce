// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <string_view>

#include <signal.h>

namespace pelage {

/// While this object exists, the first SIGINT, SIGTERM or SIGHUP only sets a flag, so that a render can write
/// a partial result. A second signal ends the process at once, unless it repeats a SIGTERM or SIGHUP within a
/// second. A signal that was already ignored when the process started (nohup) stays ignored. Only one guard
/// may exist at a time.
class SignalGuard {
 public:
  /// `note`: what the first signal writes to standard error. It must outlive the guard.
  explicit SignalGuard(std::string_view note = kPassNote);
  ~SignalGuard();
  SignalGuard(const SignalGuard&) = delete;
  SignalGuard& operator=(const SignalGuard&) = delete;

  /// Whether a signal was received. Cheap. Thread safety: may be called from any thread.
  static bool interrupted();
  /// Exit code of an interrupted run: 128 + the number of the signal that the last guard received first. This
  /// is 130 for SIGINT, 143 for SIGTERM and 129 for SIGHUP. 130 if the guard received no signal.
  static int exit_code();
  /// Whether the signal came from outside (SIGTERM or SIGHUP), not from the keyboard.
  static bool from_outside();

  static constexpr std::string_view kPassNote =
      "\npelage: stopping after this pass; press Ctrl-C again to quit now\n";
  static constexpr std::array kHandled{SIGINT, SIGTERM, SIGHUP};

 private:
  std::array<struct sigaction, kHandled.size()> old_;
};

/// While this object exists, SIGUSR1 only adds 1 to a count; otherwise SIGUSR1 ends the process. Only one
/// such object may exist at a time.
class CheckpointSignal {
 public:
  CheckpointSignal();
  ~CheckpointSignal();
  CheckpointSignal(const CheckpointSignal&) = delete;
  CheckpointSignal& operator=(const CheckpointSignal&) = delete;

  /// Number of signals so far. Cheap. Thread safety: may be called from any thread.
  static uint32_t count();

 private:
  struct sigaction old_ {};
};

/// Prepares the process for safe output. Call it once per process, before starting threads. A write beyond a
/// file size limit (SIGXFSZ) or to a closed pipe (SIGPIPE) then fails instead of ending the process. Standard
/// streams that are closed are opened on /dev/null, so that no other file gets their descriptors. Writing to
/// a standard output that was closed fails; messages to a standard error that was closed are discarded.
void prepare_process();

}  // namespace pelage
