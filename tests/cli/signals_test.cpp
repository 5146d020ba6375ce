// SPDX-License-Identifier: Apache-2.0
#include "cli/signals.h"

#include <gtest/gtest.h>
#include <unistd.h>

namespace pelage {
namespace {

TEST(Signals, TheFirstRaisesAFlag) {
  for (const int signal : {SIGINT, SIGTERM, SIGHUP}) {
    const SignalGuard guard;
    EXPECT_FALSE(SignalGuard::interrupted());
    ::raise(signal);
    EXPECT_TRUE(SignalGuard::interrupted());
    EXPECT_EQ(SignalGuard::exit_code(), 128 + signal);
  }
  const SignalGuard fresh;
  EXPECT_FALSE(SignalGuard::interrupted());
  EXPECT_EQ(SignalGuard::exit_code(), 130);
}

TEST(Signals, TheFirstOfSeveralIsTheReason) {
  const SignalGuard guard;
  ::raise(SIGTERM);
  ::raise(SIGTERM);  // sent to a process and to its group
  EXPECT_EQ(SignalGuard::exit_code(), 143);
}

TEST(Signals, IgnoredOnesStayIgnored) {
  ::signal(SIGHUP, SIG_IGN);
  {
    const SignalGuard guard;
    ::raise(SIGHUP);
    EXPECT_FALSE(SignalGuard::interrupted());
  }
  EXPECT_EQ(::signal(SIGHUP, SIG_DFL), SIG_IGN);
}

TEST(Signals, OldHandlersComeBack) {
  struct sigaction before {
  }, after{};
  ::sigaction(SIGINT, nullptr, &before);
  { const SignalGuard guard; }
  ::sigaction(SIGINT, nullptr, &after);
  EXPECT_EQ(before.sa_handler, after.sa_handler);
}

TEST(Signals, Usr1OnlyCountsWhileCheckpointsAreMade) {
  struct sigaction before {
  }, after{};
  ::sigaction(SIGUSR1, nullptr, &before);
  {
    const SignalGuard guard;
    const CheckpointSignal checkpoints;
    const uint32_t count = CheckpointSignal::count();
    ::raise(SIGUSR1);
    ::raise(SIGUSR1);
    EXPECT_EQ(CheckpointSignal::count(), count + 2);
    EXPECT_FALSE(SignalGuard::interrupted());
  }
  ::sigaction(SIGUSR1, nullptr, &after);
  EXPECT_EQ(before.sa_handler, after.sa_handler);
}

TEST(Signals, TheKeyboardIsNotOutside) {
  for (const int signal : {SIGINT, SIGTERM, SIGHUP}) {
    const SignalGuard guard;
    EXPECT_FALSE(SignalGuard::from_outside());
    ::raise(signal);
    EXPECT_EQ(SignalGuard::from_outside(), signal != SIGINT);
  }
}

TEST(SignalsDeathTest, TheSecondEndsTheProcess) {
  GTEST_FLAG_SET(death_test_style, "threadsafe");
  EXPECT_EXIT(
      {
        const SignalGuard guard;
        ::raise(SIGINT);
        ::raise(SIGINT);
      },
      testing::KilledBySignal(SIGINT), "stopping after this pass; press Ctrl-C again to quit now");
}

}  // namespace
}  // namespace pelage
