// SPDX-License-Identifier: Apache-2.0
#include "base/parallel.h"

#include <algorithm>
#include <atomic>
#include <chrono>
#include <condition_variable>
#include <mutex>
#include <set>
#include <stdexcept>
#include <thread>
#include <vector>

#include <gtest/gtest.h>
#include <sched.h>

namespace pelage {
namespace {

class WorkersOf : public ::testing::TestWithParam<int> {};
INSTANTIATE_TEST_SUITE_P(Threads, WorkersOf, ::testing::Values(1, 2, 3, 8));

TEST_P(WorkersOf, CoverEveryIndexOnceInRangesOfAtMostTheGrain) {
  const Workers workers(GetParam());
  EXPECT_EQ(workers.thread_count(), GetParam());
  for (size_t count : {0, 1, 7, 8, 9, 1000}) {
    for (size_t grain : {0, 1, 8, 5000}) {
      std::vector<std::atomic<int>> visits(count);
      std::atomic<bool> in_range = true;
      workers.for_each(count, grain, [&](WorkRange range) {
        if (range.begin >= range.end || range.end > count ||
            range.end - range.begin > std::max<size_t>(grain, 1) || range.worker < 0 ||
            range.worker >= GetParam()) {
          in_range = false;
          return;
        }
        for (size_t i = range.begin; i < range.end; ++i) ++visits[i];
      });
      EXPECT_TRUE(in_range) << count << " by " << grain;
      for (size_t i = 0; i < count; ++i) ASSERT_EQ(visits[i], 1) << i << " of " << count << " by " << grain;
    }
  }
}

// Scratch memory indexed by `worker` is never used by two threads at a time.
TEST_P(WorkersOf, GiveAWorkerNumberToOneThreadAtATime) {
  const Workers workers(GetParam());
  std::vector<std::atomic<int>> inside(static_cast<size_t>(GetParam()));
  std::atomic<int> clashes = 0;
  workers.for_each(2000, 1, [&](WorkRange range) {
    std::atomic<int>& mine = inside[static_cast<size_t>(range.worker)];
    if (++mine != 1) ++clashes;
    std::this_thread::yield();
    --mine;
  });
  EXPECT_EQ(clashes, 0);
}

// Two jobs that share a pool: each loop has every index once, and no worker but its own.
TEST_P(WorkersOf, ServeTwoThreadsOneAfterTheOther) {
  const Workers workers(GetParam());
  std::atomic<int> wrong = 0;
  const auto loops = [&] {
    for (int repetition = 0; repetition < 20; ++repetition) {
      std::vector<std::atomic<int>> inside(static_cast<size_t>(GetParam()));
      std::atomic<int> done = 0;
      workers.for_each(100, 1, [&](WorkRange range) {
        if (range.worker < 0 || range.worker >= GetParam()) {
          ++wrong;
          return;
        }
        std::atomic<int>& mine = inside[static_cast<size_t>(range.worker)];
        if (++mine != 1) ++wrong;
        std::this_thread::yield();
        --mine;
        ++done;
      });
      if (done != 100) ++wrong;
    }
  };
  std::thread other(loops);
  loops();
  other.join();
  EXPECT_EQ(wrong, 0);
}

TEST_P(WorkersOf, RunLibrariesBetweenLoops) {
  const Workers workers(GetParam());
  std::atomic<int> loops = 0, libraries = 0, wrong = 0;
  const auto loop = [&] {
    for (int repetition = 0; repetition < 20; ++repetition)
      workers.for_each(20, 1, [&](WorkRange) {
        ++loops;
        wrong += libraries > 0;
        std::this_thread::sleep_for(std::chrono::microseconds(20));
        wrong += libraries > 0;
        --loops;
      });
  };
  std::thread other(loop);
  for (int repetition = 0; repetition < 200; ++repetition)
    workers.run_library([&] {
      ++libraries;
      wrong += loops > 0;
      std::this_thread::sleep_for(std::chrono::microseconds(20));
      wrong += loops > 0;
      --libraries;
    });
  other.join();
  EXPECT_EQ(wrong, 0);
}

TEST_P(WorkersOf, StopAtTheFirstExceptionAndRethrowIt) {
  const Workers workers(GetParam());
  std::atomic<int> done = 0;
  try {
    workers.for_each(100'000, 1, [&](WorkRange range) {
      if (range.begin == 10) throw std::runtime_error("range 10");
      if (range.begin > 10) std::this_thread::sleep_for(std::chrono::milliseconds(1));
      ++done;
    });
    FAIL() << "nothing thrown";
  } catch (const std::runtime_error& error) {
    EXPECT_STREQ(error.what(), "range 10");
  }
  EXPECT_LT(done, 100'000 - 1);
  std::atomic<int> after = 0;
  workers.for_each(100, 1, [&](WorkRange) { ++after; });
  EXPECT_EQ(after, 100);  // the team still works
}

TEST(Workers, RunAtTheSameTimeOnThreadsOfTheirOwn) {
  if (available_processors() < 2) GTEST_SKIP() << "one processor";
  const Workers workers(2);
  std::mutex mutex;
  std::condition_variable changed;
  std::set<std::thread::id> threads;
  // Each of two ranges waits until both have begun: with one thread this would never end.
  workers.for_each(2, 1, [&](WorkRange) {
    std::unique_lock lock(mutex);
    threads.insert(std::this_thread::get_id());
    changed.notify_all();
    changed.wait_for(lock, std::chrono::seconds(60), [&] { return threads.size() == 2; });
  });
  EXPECT_EQ(threads.size(), 2u);
}

TEST(Workers, TeamsNest) {
  const Workers outer(2);
  std::atomic<int> sum = 0;
  outer.for_each(4, 1, [&](WorkRange) {
    const Workers inner(2);
    inner.for_each(10, 1, [&](WorkRange) { ++sum; });
  });
  EXPECT_EQ(sum, 40);
}

TEST(Workers, AloneWorksInPlaceInsideAnotherTeam) {
  const Workers outer(3);
  std::atomic<int> sum = 0, elsewhere = 0;
  outer.for_each(30, 1, [&](WorkRange) {
    const std::thread::id here = std::this_thread::get_id();
    const Workers alone = Workers::alone();
    EXPECT_EQ(alone.thread_count(), 1);
    alone.for_each(10, 3, [&](WorkRange range) {
      sum += static_cast<int>(range.end - range.begin);
      elsewhere += std::this_thread::get_id() != here || range.worker != 0;
    });
    alone.run_library([&] { elsewhere += std::this_thread::get_id() != here; });
    EXPECT_THROW(alone.for_each(1, 1, [](WorkRange) { throw 7; }), int);
  });
  EXPECT_EQ(sum, 300);
  EXPECT_EQ(elsewhere, 0);
}

TEST(AvailableProcessors, FollowTheAffinityOfTheThread) {
  EXPECT_GE(available_processors(), 1);
  int restricted = 0;
  std::thread([&] {
    const int processor = ::sched_getcpu();
    cpu_set_t one;
    CPU_ZERO(&one);
    CPU_SET(processor, &one);
    if (::sched_setaffinity(0, sizeof(one), &one) == 0) restricted = available_processors();
  }).join();
  EXPECT_EQ(restricted, 1);
}

}  // namespace
}  // namespace pelage
