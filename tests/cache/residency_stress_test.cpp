// SPDX-License-Identifier: Apache-2.0
#include <cstdio>
#include <cstdlib>
#include <set>
#include <stdexcept>
#include <string>
#include <thread>

#include <gtest/gtest.h>

#include "base/hash.h"
#include "tests/cache/test_grower.h"
#include "tests/soak.h"

namespace pelage {
namespace {

constexpr int kThreads = 4;
constexpr size_t kSlots = 300;
constexpr size_t kMaxWords = 512;

/// Percent of all units; 0 is just the largest of them, so that threads grow one after the other.
class ResidencyStress : public testing::TestWithParam<int> {
 protected:
  ResidencyStress() : grower_(kSlots, kMaxWords, 3) {}

  /// A budget beside `fixed_` bytes of film.
  uint64_t limit(int percent) {
    MemoryLedger ledger;
    const Residency empty(grower_, kSlots, kThreads, {}, ledger, MemoryTag::kChunks);
    const uint64_t wanted = grower_.all_bytes() * static_cast<uint64_t>(percent) / 100;
    return static_cast<uint64_t>(ledger.budgeted() + fixed_) +
           std::max(wanted, grower_.largest_reservation());
  }

  TestGrower grower_;
  MemoryLedger ledger_;
  const int64_t fixed_ = 10'000;
};

INSTANTIATE_TEST_SUITE_P(Percent, ResidencyStress, testing::Values(100, 50, 25, 10, 5, 0));

/// Threads dwell among a few slots as rays do, and now and then go elsewhere. Where most slots are resident
/// they go more often, so that every budget sees its evictions.
class Walk {
 public:
  Walk(uint64_t seed, int percent) : seed_(seed), one_in_(percent >= 50 ? 8 : 40) {}
  uint32_t next() {
    const uint64_t random = hash64(seed_, ++step_);
    if ((random >> 40) % one_in_ == 0) home_ = static_cast<uint32_t>((random >> 8) % kSlots);
    return (home_ + static_cast<uint32_t>(random % 2)) % kSlots;
  }
  uint64_t step() const { return step_; }

 private:
  const uint64_t seed_;
  const uint64_t one_in_;
  uint64_t step_ = 0;
  uint32_t home_ = 0;
};

TEST_P(ResidencyStress, EveryVisitSeesItsUnitWhole) {
  const MemoryCharge film(ledger_, MemoryTag::kFilm, fixed_);
  const uint64_t max = limit(GetParam());
  grower_.before = [](uint32_t, uint64_t) { std::this_thread::yield(); };
  const uint64_t visits = 170'000 * soak_scale();
  ResidencyCounts counts;
  {
    Residency residency(grower_, kSlots, kThreads, MemoryBudget{max}, ledger_, MemoryTag::kChunks);
    std::atomic<uint64_t> broken = 0;
    std::vector<std::thread> threads;
    for (int thread = 0; thread < kThreads; ++thread) {
      threads.emplace_back([&, thread] {
        Walk walk(hash64(11, static_cast<uint64_t>(thread / 2)), GetParam());  // in pairs: they contend
        while (walk.step() < visits / kThreads) {
          const uint32_t slot = walk.next();
          const bool whole = residency.visit(
              slot, thread, [&](Resident& unit) { return is_whole(unit, slot, walk.step()); });
          if (!whole) broken.fetch_add(1);
          if (slot % 3 == 0) residency.mark_hit(slot);
        }
      });
    }
    for (std::thread& thread : threads) thread.join();
    EXPECT_EQ(broken, 0u);
    counts = residency.counts();
    EXPECT_EQ(ledger_.current(MemoryTag::kChunks) > grower_.live_bytes(), true);  // by the index
  }
  EXPECT_EQ(ledger_.budgeted(), fixed_);
  EXPECT_EQ(grower_.live_bytes(), 0);
  EXPECT_LE(ledger_.peak(MemoryTag::kChunks) + fixed_, static_cast<int64_t>(max));
  EXPECT_LE(grower_.live_peak(), counts.peak_bytes);
  EXPECT_EQ(counts.expansions, grower_.grown());
  EXPECT_EQ(counts.expansions, counts.touched + counts.reexpansions);
  EXPECT_EQ(counts.touched, static_cast<int64_t>(kSlots));
  EXPECT_EQ(counts.working_set_bytes, static_cast<int64_t>(grower_.all_bytes()));
  EXPECT_EQ(counts.overruns, 0);
  EXPECT_GE(counts.expansions, counts.evictions);
  if (GetParam() < 100) {
    EXPECT_GE(counts.evictions, static_cast<int64_t>(2'000 * soak_scale()));
  }
  std::printf("%llu visits, %lld evictions, %.2f s waited\n", static_cast<unsigned long long>(visits),
              static_cast<long long>(counts.evictions), counts.waited_s);
}

TEST_P(ResidencyStress, GrowersThatFailNowAndThen) {
  // What fails is decided by the number of the growth, so that slots fail at first and at later growths.
  grower_.before = [](uint32_t slot, uint64_t number) {
    if (hash64(5, number) % 16 == 0) throw std::runtime_error(std::to_string(slot));
  };
  const uint64_t visits = 20'000 * soak_scale();
  {
    Residency residency(grower_, kSlots, kThreads, MemoryBudget{limit(GetParam())}, ledger_,
                        MemoryTag::kChunks);
    std::atomic<uint64_t> broken = 0;
    std::vector<std::set<uint32_t>> failed(kThreads);
    std::vector<std::thread> threads;
    for (int thread = 0; thread < kThreads; ++thread) {
      threads.emplace_back([&, thread] {
        std::set<uint32_t>& mine = failed[static_cast<size_t>(thread)];
        Walk walk(hash64(12, static_cast<uint64_t>(thread)), GetParam());
        while (walk.step() < visits / kThreads) {
          const uint32_t slot = walk.next();
          try {
            if (!residency.visit(slot, thread, [&](Resident& unit) { return is_whole(unit, slot); }) ||
                mine.contains(slot)) {
              broken.fetch_add(1);
            }
          } catch (const std::runtime_error& error) {
            if (error.what() != std::to_string(slot)) broken.fetch_add(1);
            mine.insert(slot);
          }
        }
      });
    }
    for (std::thread& thread : threads) thread.join();
    EXPECT_EQ(broken, 0u);
    std::set<uint32_t> all;
    for (const auto& mine : failed) all.insert(mine.begin(), mine.end());
    EXPECT_GT(all.size(), 0u);
    // Who failed for one fails for all.
    for (uint32_t slot : all) {
      EXPECT_THROW(residency.visit(slot, 0, [](Resident&) {}), std::runtime_error);
    }
    EXPECT_EQ(residency.counts().expansions + static_cast<int64_t>(all.size()), grower_.grown());
  }
  EXPECT_EQ(ledger_.budgeted(), 0);
  EXPECT_EQ(grower_.live_bytes(), 0);
}

}  // namespace
}  // namespace pelage
