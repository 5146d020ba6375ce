// SPDX-License-Identifier: Apache-2.0
#include "cache/residency.h"

#include <array>
#include <latch>
#include <regex>
#include <stdexcept>
#include <string>
#include <thread>

#include <gtest/gtest.h>

#include "base/error.h"
#include "base/parallel.h"
#include "base/progress.h"
#include "tests/cache/test_grower.h"

namespace pelage::residency_test {
namespace {

constexpr size_t kWords = 1000;
constexpr size_t kBytes = kWords * sizeof(uint64_t);

std::string text_of(const std::function<void()>& action, ErrorKind kind) {
  try {
    action();
  } catch (const Error& error) {
    EXPECT_EQ(error.kind(), kind);
    EXPECT_EQ(error.problems().size(), 1u);
    return error.what();
  }
  ADD_FAILURE() << "nothing thrown";
  return {};
}

/// Bytes of a residency's own index.
int64_t index_bytes(Grower& grower, size_t slots, int threads) {
  MemoryLedger ledger;
  const Residency empty(grower, slots, threads, {}, ledger, MemoryTag::kChunks);
  return ledger.budgeted();
}

/// Equal units of 8000 bytes under a budget of `units` of them, reservations being twice that.
class ResidencyTest : public testing::Test {
 protected:
  void make(size_t slots, int threads, double units) {
    const auto limit = index_bytes(grower_, slots, threads) + static_cast<int64_t>(units * kBytes);
    residency_.emplace(grower_, slots, threads, MemoryBudget{static_cast<uint64_t>(limit)}, ledger_,
                       MemoryTag::kChunks);
  }
  bool visit(uint32_t slot, int thread = 0) {
    return residency_->visit(slot, thread, [&](Resident& unit) { return is_whole(unit, slot); });
  }

  MemoryLedger ledger_;
  TestGrower grower_ = TestGrower::of_equal_units(100, kWords);
  std::optional<Residency> residency_;
};

TEST_F(ResidencyTest, GrowsOnFirstVisitAndOnlyThen) {
  make(10, 1, 1000);
  EXPECT_FALSE(residency_->is_resident(3));
  EXPECT_TRUE(visit(3));
  const double cpu_s = residency_->counts().cpu_s;
  EXPECT_TRUE(visit(3) && residency_->counts().cpu_s == cpu_s);
  EXPECT_TRUE(residency_->is_resident(3));
  EXPECT_TRUE(visit(4));
  const ResidencyCounts counts = residency_->counts();
  EXPECT_EQ(counts.expansions, 2);
  EXPECT_TRUE(cpu_s > 0 && counts.cpu_s > cpu_s);
  EXPECT_EQ(counts.touched, 2);
  EXPECT_EQ(counts.reexpansions, 0);
  EXPECT_EQ(counts.evictions, 0);
  EXPECT_EQ(counts.working_set_bytes, int64_t(2 * kBytes));
  EXPECT_EQ(counts.peak_bytes, int64_t(3 * kBytes));  // one held and one reserved
  EXPECT_EQ(counts.overruns, 0);
  residency_.reset();
  EXPECT_EQ(ledger_.budgeted(), 0);
  EXPECT_EQ(grower_.live_bytes(), 0);
}

TEST_F(ResidencyTest, ReturnsWhatTheVisitReturns) {
  make(2, 1, 4);
  int number = 7;
  int& same = residency_->visit(0, 0, [&](Resident&) -> int& { return number; });
  EXPECT_EQ(&same, &number);
  EXPECT_THROW(residency_->visit(0, 0, [](Resident&) { throw std::runtime_error("of the visitor"); }),
               std::runtime_error);
  EXPECT_TRUE(visit(0));  // and the pin was let go
}

TEST_F(ResidencyTest, EvictsUnderTheBudgetAndGrowsAgain) {
  make(10, 1, 4);
  for (int round = 0; round < 3; ++round) {
    for (uint32_t slot = 0; slot < 10; ++slot) EXPECT_TRUE(visit(slot));
  }
  const ResidencyCounts counts = residency_->counts();
  EXPECT_EQ(counts.touched, 10);
  EXPECT_EQ(counts.expansions, 30);
  EXPECT_EQ(counts.reexpansions, 20);
  EXPECT_GE(counts.evictions, 27);
  EXPECT_EQ(counts.working_set_bytes, int64_t(10 * kBytes));
  EXPECT_LE(counts.peak_bytes, int64_t(4 * kBytes));
  EXPECT_LE(grower_.live_peak(), int64_t(4 * kBytes));
}

TEST_F(ResidencyTest, KeepsWhatIsUsed) {
  make(50, 1, 6);
  visit(0);
  for (uint32_t slot = 1; slot < 50; ++slot) {
    EXPECT_TRUE(visit(0));
    EXPECT_TRUE(visit(slot));
  }
  EXPECT_EQ(residency_->counts().reexpansions, 0);  // each of 0 .. 49 was grown once, 0 among them
}

TEST_F(ResidencyTest, CountsUnitsThatNothingHit) {
  make(10, 1, 4);
  for (uint32_t slot = 0; slot < 10; ++slot) {
    visit(slot);
    if (slot % 2) residency_->mark_hit(slot);
  }
  EXPECT_EQ(residency_->counts().false_expansions, 5);
  visit(1);  // grown again, and not hit this time
  EXPECT_EQ(residency_->counts().false_expansions, 6);
}

TEST_F(ResidencyTest, NeverTakesWhatAVisitHolds) {
  make(100, 2, 5);
  std::latch held(1), churned(1);
  std::thread holder([&] {
    residency_->visit(0, 0, [&](Resident& unit) {
      held.count_down();
      churned.wait();
      for (uint64_t i = 0; i < kWords; ++i) EXPECT_TRUE(is_whole(unit, 0, i));
    });
  });
  held.wait();
  for (int round = 0; round < 5; ++round) {
    for (uint32_t slot = 1; slot < 100; ++slot) EXPECT_TRUE(visit(slot, 1));
  }
  EXPECT_TRUE(residency_->is_resident(0));
  churned.count_down();
  holder.join();
  EXPECT_GT(residency_->counts().evictions, 400);
}

TEST_F(ResidencyTest, GrowsOnceForAllWhoWait) {
  make(4, 4, 100);
  grower_.before = [](uint32_t, uint64_t) { std::this_thread::sleep_for(std::chrono::milliseconds(30)); };
  std::vector<std::thread> threads;
  std::latch together(4);
  for (int thread = 0; thread < 4; ++thread) {
    threads.emplace_back([&, thread] {
      together.arrive_and_wait();
      EXPECT_TRUE(visit(2, thread));
    });
  }
  for (std::thread& thread : threads) thread.join();
  EXPECT_EQ(grower_.grown(), 1);
  EXPECT_GT(residency_->counts().waited_s, 0);
}

TEST_F(ResidencyTest, FailuresReachEveryoneWhoNeedsTheSlot) {
  make(4, 4, 100);
  grower_.before = [](uint32_t slot, uint64_t) {
    std::this_thread::sleep_for(std::chrono::milliseconds(30));
    if (slot == 2) throw Error(ErrorKind::kInput, "no hair on slot 2");
  };
  std::vector<std::thread> threads;
  std::latch together(4);
  std::atomic<int> told = 0;
  for (int thread = 0; thread < 4; ++thread) {
    threads.emplace_back([&, thread] {
      together.arrive_and_wait();
      try {
        visit(2, thread);
      } catch (const Error& error) {
        told += error.what() == std::string("no hair on slot 2");
      }
      EXPECT_TRUE(visit(3, thread));
    });
  }
  for (std::thread& thread : threads) thread.join();
  EXPECT_EQ(told, 4);
  EXPECT_EQ(text_of([&] { visit(2); }, ErrorKind::kInput), "no hair on slot 2");
  EXPECT_EQ(residency_->counts().expansions, 1);
  EXPECT_EQ(grower_.grown(), 2);
  residency_.reset();
  EXPECT_EQ(ledger_.budgeted(), 0);
  EXPECT_EQ(grower_.live_bytes(), 0);
}

// Others took of the budget meanwhile, so that both threads' chunks no longer fit together: one waits, asleep
// and empty-handed, until the other has let go.
TEST_F(ResidencyTest, WaitsForRoomUntilAPinIsLetGo) {
  make(4, 2, 5);
  const MemoryCharge poses(ledger_, MemoryTag::kSkins, int64_t(2.5 * kBytes));
  std::latch held(1);
  std::atomic<bool> let_go = false;
  std::thread holder([&] {
    residency_->visit(0, 0, [&](Resident&) {
      held.count_down();
      std::this_thread::sleep_for(std::chrono::milliseconds(50));
      let_go = true;
    });
  });
  held.wait();
  residency_->visit(1, 1, [&](Resident& unit) {
    EXPECT_TRUE(let_go);
    EXPECT_TRUE(is_whole(unit, 1));
  });
  holder.join();
  EXPECT_FALSE(residency_->is_resident(0));
  EXPECT_GT(residency_->counts().waited_s, 0);
}

TEST_F(ResidencyTest, SaysSoWhenOthersTookTheBudget) {
  make(4, 2, 5);
  EXPECT_TRUE(visit(0));
  {
    const MemoryCharge poses(ledger_, MemoryTag::kSkins, int64_t(4 * kBytes));
    const std::string text = text_of([&] { visit(1); }, ErrorKind::kMemory);
    EXPECT_NE(text.find("render.memory"), std::string::npos) << text;
    EXPECT_NE(text.find("skins 31 KiB"), std::string::npos) << text;
    EXPECT_TRUE(residency_->is_resident(0));  // nothing was given up in vain
  }
  EXPECT_TRUE(visit(1));
}

TEST_F(ResidencyTest, RefusesABudgetBelowTheLargestChunk) {
  const MemoryCharge film(ledger_, MemoryTag::kFilm, 3 << 20);
  const MemoryCharge libraries(ledger_, MemoryTag::kLibraries, 50 << 20);  // not of the budget
  TestGrower grower = TestGrower::of_equal_units(100, (1 << 20) / 8);
  const auto with_limit = [&](uint64_t limit) {
    Residency residency(grower, 100, 4, MemoryBudget{limit}, ledger_, MemoryTag::kChunks);
    EXPECT_TRUE(residency.visit(5, 3, [](Resident& unit) { return is_whole(unit, 5); }));
  };
  const std::string text = text_of([&] { with_limit(4 << 20); }, ErrorKind::kMemory);
  EXPECT_NE(text.find("render.memory (4.0 MiB)"), std::string::npos) << text;
  EXPECT_NE(text.find("film 3.0 MiB"), std::string::npos) << text;
  EXPECT_EQ(text.find("libraries"), std::string::npos) << text;
  EXPECT_NE(text.find("the largest chunk needs 2.0 MiB"), std::string::npos) << text;
  // What it says would do does, and a MiB less does not.
  std::smatch match;
  ASSERT_TRUE(std::regex_search(text, match, std::regex("; give at least (\\d+)M")));
  const uint64_t min = std::stoull(match[1]) << 20;
  with_limit(min);
  EXPECT_THROW(with_limit(min - (1 << 20)), Error);
  EXPECT_EQ(ledger_.budgeted(), 3 << 20);
}

TEST_F(ResidencyTest, FewSlotsNeedNoMoreThanTheyAre) {
  make(2, 64, 4);
  EXPECT_TRUE(visit(0, 5));
  EXPECT_TRUE(visit(1, 63));
}

TEST_F(ResidencyTest, NoLimitKeepsEverything) {
  residency_.emplace(grower_, 100, 2, MemoryBudget{}, ledger_, MemoryTag::kChunks);
  for (int round = 0; round < 2; ++round) {
    for (uint32_t slot = 0; slot < 100; ++slot) EXPECT_TRUE(visit(slot, round));
  }
  EXPECT_EQ(residency_->counts().expansions, 100);
  EXPECT_EQ(residency_->counts().evictions, 0);
}

TEST_F(ResidencyTest, EagerlyGrowsEverythingOnce) {
  make(100, 4, 120);
  const Workers workers(4);
  NoProgress progress;
  residency_->grow_all({workers, ledger_, progress});
  EXPECT_EQ(residency_->counts().expansions, 100);
  for (uint32_t slot = 0; slot < 100; ++slot) {
    EXPECT_TRUE(residency_->is_resident(slot));
    EXPECT_TRUE(visit(slot));
  }
  EXPECT_EQ(residency_->counts().expansions, 100);
  EXPECT_EQ(residency_->counts().evictions, 0);
  residency_.reset();
  EXPECT_EQ(ledger_.budgeted(), 0);
  EXPECT_EQ(grower_.live_bytes(), 0);
}

TEST_F(ResidencyTest, EagerlyRefusesWhatDoesNotFit) {
  make(100, 4, 60);
  const Workers workers(4);
  NoProgress progress;
  const std::string text = text_of(
      [&] {
        residency_->grow_all({workers, ledger_, progress});
      },
      ErrorKind::kMemory);
  EXPECT_NE(text.find("render.memory"), std::string::npos) << text;
  EXPECT_LE(grower_.live_peak(), int64_t(60 * kBytes));
  residency_.reset();
  EXPECT_EQ(ledger_.budgeted(), 0);
}

TEST_F(ResidencyTest, EagerlyStopsWhenCancelled) {
  class StopAtTen final : public Progress {
   public:
    void begin(std::string_view, double) override {}
    void advance(double amount) override { done_.fetch_add(static_cast<int>(amount)); }
    void end() override {}
    bool cancelled() const override { return done_ >= 10; }

   private:
    std::atomic<int> done_{0};
  } progress;
  make(100, 2, 500);
  const Workers workers(2);
  residency_->grow_all({workers, ledger_, progress});
  EXPECT_GE(residency_->counts().expansions, 10);
  EXPECT_LE(residency_->counts().expansions, 12);
}

TEST_F(ResidencyTest, ChargesHonestlyWhatAGrowerUnderstated) {
  class Understating final : public Grower {
   public:
    size_t reserve_bytes(uint32_t) const override { return 100; }
    Grown grow(uint32_t) override { return {std::make_unique<Resident>(), 150}; }
  } grower;
  Residency residency(grower, 3, 1, MemoryBudget{100'000}, ledger_, MemoryTag::kChunks);
  const int64_t index = ledger_.budgeted();
  residency.visit(0, 0, [](Resident&) {});
  EXPECT_EQ(residency.counts().overruns, 1);
  EXPECT_EQ(ledger_.budgeted() - index, 150);
}

/// Where every third slot takes more than it was thought to, as is found out when it is first grown.
class SurprisedGrower final : public Grower {
 public:
  static bool is_surprise(uint32_t slot) { return slot % 3 == 0; }
  size_t reserve_bytes(uint32_t slot) const override {
    return known_[slot].load() ? 3 * kBytes : size_t(kBytes);
  }
  Grown grow(uint32_t slot) override {
    ++calls;
    if (is_surprise(slot) && !known_[slot].load()) {
      std::this_thread::sleep_for(std::chrono::milliseconds(1));
      known_[slot].store(true);
      return {nullptr, 3 * kBytes};
    }
    return {std::make_unique<Resident>(), is_surprise(slot) ? 2 * kBytes : size_t(kBytes)};
  }

  std::atomic<int> calls{0};

 private:
  std::array<std::atomic<bool>, 100> known_{};
};

TEST_F(ResidencyTest, ReservesMoreForASlotThatTurnsOutToTakeMore) {
  for (const double units : {3.0, 7.5, 12.0}) {
    SurprisedGrower grower;
    MemoryLedger ledger;
    const int64_t limit = index_bytes(grower, 60, 4) + static_cast<int64_t>(units * kBytes);
    Residency residency(grower, 60, 4, MemoryBudget{static_cast<uint64_t>(limit)}, ledger,
                        MemoryTag::kChunks);
    std::vector<std::thread> threads;
    for (int thread = 0; thread < 4; ++thread) {
      threads.emplace_back([&, thread] {
        for (uint32_t i = 0; i < 300; ++i)
          residency.visit(hash64(i / 3, thread / 2) % 60, thread, [](Resident&) {});
      });
    }
    for (std::thread& thread : threads) thread.join();
    const ResidencyCounts counts = residency.counts();
    EXPECT_EQ(counts.overruns, 0);
    EXPECT_LE(ledger.peak(MemoryTag::kChunks), limit);
    EXPECT_GT(counts.evictions, 0);
    EXPECT_GT(grower.calls, counts.expansions);  // surprises
  }
}

TEST_F(ResidencyTest, SaysSoWhenASlotThatTakesMoreDoesNotFit) {
  SurprisedGrower grower;
  const int64_t limit = index_bytes(grower, 6, 1) + int64_t(2.5 * kBytes);
  Residency residency(grower, 6, 1, MemoryBudget{static_cast<uint64_t>(limit)}, ledger_, MemoryTag::kChunks);
  residency.visit(1, 0, [](Resident&) {});
  EXPECT_NE(text_of([&] { residency.visit(3, 0, [](Resident&) {}); }, ErrorKind::kMemory).find("is full"),
            std::string::npos);
  residency.visit(2, 0, [](Resident&) {});
}

using ResidencyDeathTest = ResidencyTest;
TEST_F(ResidencyDeathTest, AVisitInsideAVisitIsABug) {
  GTEST_FLAG_SET(death_test_style, "threadsafe");
  make(4, 1, 10);
  EXPECT_DEATH(residency_->visit(0, 0, [&](Resident&) { visit(1); }), "hazard");
  // Without a budget too, where it would do no harm.
  residency_.emplace(grower_, 4, 2, MemoryBudget{}, ledger_, MemoryTag::kChunks);
  EXPECT_DEATH(residency_->visit(0, 0, [&](Resident&) { visit(1); }), "hazard");
  EXPECT_TRUE(residency_->visit(0, 0, [&](Resident&) { return visit(1, 1); }));
  EXPECT_TRUE(visit(1));
}

}  // namespace
}  // namespace pelage::residency_test
