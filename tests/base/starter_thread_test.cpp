// SPDX-License-Identifier: Apache-2.0
#include "base/starter_thread.h"

#include <atomic>
#include <csignal>
#include <system_error>
#include <vector>

#include <gtest/gtest.h>
#include <sys/prctl.h>
#include <sys/wait.h>
#include <unistd.h>

namespace pelage {
namespace {

TEST(StarterThreadTest, RunsTheTasksOfAllThreadsOnOneThread) {
  StarterThread starter;
  std::atomic<int> count{0};
  std::thread::id on;
  starter.run([&] { on = std::this_thread::get_id(); });
  EXPECT_NE(on, std::this_thread::get_id());
  std::vector<std::thread> threads;
  for (int i = 0; i < 8; ++i) {
    threads.emplace_back([&] {
      for (int k = 0; k < 50; ++k) starter.run([&] { count += on == std::this_thread::get_id(); });
    });
  }
  for (std::thread& thread : threads) thread.join();
  EXPECT_EQ(count, 400);
}

TEST(StarterThreadTest, ProcessesOutliveTheThreadThatAskedForThem) {
  pid_t child = -1;
  const auto start = [&] {
    child = ::fork();
    if (child != 0) return;
    ::prctl(PR_SET_PDEATHSIG, SIGKILL);
    for (;;) ::pause();
  };
  int status = 0;
  {
    StarterThread starter;
    std::thread([&] { starter.run(start); }).join();
    ASSERT_GT(child, 0);
    ::usleep(50'000);
    EXPECT_EQ(::waitpid(child, &status, WNOHANG), 0);
    ::kill(child, SIGCONT);
  }
  ASSERT_EQ(::waitpid(child, &status, 0), child);  // ended with the starter
  EXPECT_TRUE(WIFSIGNALED(status) && WTERMSIG(status) == SIGKILL);
}

TEST(StarterThreadTest, SignalsArriveAgainWhenTheThreadCannotStart) {
  pthread_attr_t usual, huge;
  ASSERT_EQ(::pthread_getattr_default_np(&usual), 0);
  ASSERT_EQ(::pthread_attr_init(&huge), 0);
  ASSERT_EQ(::pthread_attr_setstacksize(&huge, size_t(1) << 47), 0);  // all addresses of a process
  ASSERT_EQ(::pthread_setattr_default_np(&huge), 0);
  EXPECT_THROW(StarterThread(), std::system_error);
  EXPECT_EQ(::pthread_setattr_default_np(&usual), 0);
  sigset_t blocked;
  ::pthread_sigmask(SIG_SETMASK, nullptr, &blocked);
  EXPECT_EQ(sigismember(&blocked, SIGUSR1), 0);
  EXPECT_EQ(sigismember(&blocked, SIGTERM), 0);
  ::pthread_attr_destroy(&huge);
  ::pthread_attr_destroy(&usual);
}

}  // namespace
}  // namespace pelage
