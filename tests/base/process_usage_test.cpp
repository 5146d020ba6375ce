// SPDX-License-Identifier: Apache-2.0
#include "base/process_usage.h"

#include <cstring>
#include <memory>
#include <thread>

#include <gtest/gtest.h>

namespace pelage {
namespace {

TEST(ResidentSet, GrowsWithTouchedMemoryAndThePeakRemembersIt) {
  constexpr int64_t kBytes = 64 << 20;
  const int64_t before = current_rss_bytes();
  ASSERT_GT(before, 0);
  auto block = std::make_unique_for_overwrite<char[]>(kBytes);
  std::memset(block.get(), 1, kBytes);
  const int64_t held = current_rss_bytes();
  EXPECT_GE(held - before, kBytes * 9 / 10);
  block.reset();
  EXPECT_GE(peak_rss_bytes(), before + kBytes * 9 / 10);
}

TEST(CpuSeconds, AdvanceWithWork) {
  const double before = cpu_seconds();
  volatile uint64_t x = 1;
  for (int i = 0; i < 100'000'000; ++i) x = x * 6364136223846793005ull + 1;
  EXPECT_GT(cpu_seconds(), before);
}

TEST(ThreadCpuSeconds, AreThoseOfTheCallingThread) {
  const double before = thread_cpu_seconds();
  std::thread other([] {
    while (thread_cpu_seconds() < 0.05) {
    }
  });
  other.join();
  const double after = thread_cpu_seconds();
  EXPECT_LT(after - before, 0.05);
  while (thread_cpu_seconds() == after) {
  }
  EXPECT_GT(cpu_seconds(), 0.05);
}

}  // namespace
}  // namespace pelage
