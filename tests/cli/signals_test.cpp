// SPDX-License-Identifier: Apache-2.0
#include "cli/signals.h"

#include <gtest/gtest.h>
#include <unistd.h>

namespace pelage {
namespace {

TEST(Signals, TheFirstRaisesAFlag) {
  for (const int signal : {SIGINT, SIGTERM}) {
    const SignalGuard guard;
    EXPECT_FALSE(SignalGuard::interrupted());
    ::raise(signal);
    EXPECT_TRUE(SignalGuard::interrupted());
  }
  const SignalGuard fresh;
  EXPECT_FALSE(SignalGuard::interrupted());
}

TEST(Signals, OldHandlersComeBack) {
  struct sigaction before {
  }, after{};
  ::sigaction(SIGINT, nullptr, &before);
  { const SignalGuard guard; }
  ::sigaction(SIGINT, nullptr, &after);
  EXPECT_EQ(before.sa_handler, after.sa_handler);
}

TEST(SignalsDeathTest, TheSecondEndsTheProcess) {
  GTEST_FLAG_SET(death_test_style, "threadsafe");
  EXPECT_EXIT(
      {
        const SignalGuard guard;
        ::raise(SIGINT);
        ::raise(SIGINT);
      },
      testing::KilledBySignal(SIGINT), "stopping; once more ends at once");
}

}  // namespace
}  // namespace pelage
