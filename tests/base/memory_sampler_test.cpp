// SPDX-License-Identifier: Apache-2.0
#include "base/memory_sampler.h"

#include <cstring>
#include <vector>

#include <gtest/gtest.h>
#include <sys/mman.h>

#include "base/process_usage.h"

namespace pelage {
namespace {

using Clock = MemorySampler::Clock;

TEST(ResidentMemory, SeesPagesThatAreTouched) {
  constexpr size_t kBytes = size_t(64) << 20;
  const ResidentMemory before = resident_memory();
  EXPECT_GT(before.anonymous, 0);
  EXPECT_GT(before.file, 0);
  const std::vector<char> pages(kBytes, 1);
  const ResidentMemory after = resident_memory();
  EXPECT_GT(pages[kBytes / 2], 0);
  // Room for the counters that the kernel keeps per thread, and for shadow pages of a sanitizer.
  EXPECT_GE(after.anonymous - before.anonymous, int64_t(kBytes) * 9 / 10);
  EXPECT_NEAR(static_cast<double>(after.anonymous + after.file), static_cast<double>(current_rss_bytes()),
              double(16 << 20));
}

/// Memory that is gone when it is released: the address sanitizer keeps what the heap gets back for a while.
class TouchedPages {
 public:
  explicit TouchedPages(size_t bytes)
      : bytes_(bytes),
        pages_(::mmap(nullptr, bytes, PROT_READ | PROT_WRITE, MAP_PRIVATE | MAP_ANONYMOUS, -1, 0)) {
    if (pages_ != MAP_FAILED) std::memset(pages_, 1, bytes_);
  }
  ~TouchedPages() {
    if (pages_ != MAP_FAILED) ::munmap(pages_, bytes_);
  }
  TouchedPages(const TouchedPages&) = delete;
  TouchedPages& operator=(const TouchedPages&) = delete;

 private:
  size_t bytes_;
  void* pages_;
};

TEST(MemorySampler, KeepsTheLedgerOfTheHighestMoment) {
  MemoryLedger ledger;
  MemorySampler sampler(ledger, Clock::now(), 0.001);
  {
    // Charged before the pages are there and until they are gone: no sample of them is without it.
    const MemoryCharge charge(ledger, MemoryTag::kFilm, int64_t(96) << 20);
    const TouchedPages pages(size_t(96) << 20);
    // At least one sample begins and ends in here, however slow the machine.
    const auto until = Clock::now() + std::chrono::milliseconds(100);
    while (Clock::now() < until) std::this_thread::yield();
    std::this_thread::sleep_for(std::chrono::milliseconds(50));
  }
  const MemoryHistory& history = sampler.stop();
  ASSERT_GE(history.timeline.size(), 2u);
  EXPECT_EQ(history.highest.tagged(), int64_t(96) << 20);
  EXPECT_EQ(history.highest.tags[static_cast<size_t>(MemoryTag::kFilm)], int64_t(96) << 20);
  EXPECT_EQ(history.timeline.back().tagged(), 0);
  double last = -1;
  for (const MemorySample& sample : history.timeline) {
    EXPECT_LE(sample.resident.anonymous, history.highest.resident.anonymous);
    EXPECT_GT(sample.seconds, last);
    last = sample.seconds;
  }
}

TEST(MemorySampler, StopsAtOnceAndOnlyOnce) {
  MemoryLedger ledger;
  const auto began = Clock::now();
  MemorySampler sampler(ledger, began, 3600);
  const size_t samples = sampler.stop().timeline.size();
  EXPECT_LT(Clock::now() - began, std::chrono::minutes(30));
  EXPECT_GE(samples, 2u);
  EXPECT_EQ(sampler.stop().timeline.size(), samples);
}

TEST(MemorySampler, LivesBesideThreadsThatCharge) {
  MemoryLedger ledger;
  for (int round = 0; round < 20; ++round) {
    MemorySampler sampler(ledger, Clock::now(), 0.0001);
    std::thread charger([&] {
      for (int i = 0; i < 1000; ++i) const MemoryCharge charge(ledger, MemoryTag::kChunks, i);
    });
    charger.join();
  }
  EXPECT_EQ(ledger.current(MemoryTag::kChunks), 0);
}

}  // namespace
}  // namespace pelage
