// SPDX-License-Identifier: Apache-2.0
// What grooms hold while they are made is what they asked for, or they are refused before.
#include <atomic>

#include <gtest/gtest.h>

#include "base/error.h"
#include "groom/clump.h"
#include "tests/groom/operator_harness.h"
#include "tests/groom/scene_text.h"
#include "tests/support/allocation_meter.h"

namespace pelage {
namespace {

class GroomMemoryTest : public OperatorTest {
 protected:
  FollicleOptions options(int64_t count, const char* density = "1") const {
    FollicleOptions options;
    options.count = count;
    options.density = scene_text::read<Field>(density);
    options.owner = "groom 'coat'";
    return options;
  }
  /// What `make` holds at most beyond what is held before.
  template <class Make>
  static int64_t peak_of(const Make& make) {
    const size_t before = live_bytes();
    reset_peak();
    make();
    return static_cast<int64_t>(peak_bytes() - before);
  }
};

TEST_F(GroomMemoryTest, PlacingFolliclesHoldsWhatItAsksFor) {
  for (const char* density : {"1", "{ramp: {along: y, knots: [[-1, 0.2], [1, 1]]}}"}) {
    for (const int64_t count : {20'000, 60'000}) {
      const FollicleOptions wanted = options(count, density);
      FollicleTree tree;
      MemoryLedger ledger;
      const Job job{workers_, ledger, progress_};
      const int64_t peak = peak_of([&] { tree = FollicleTree::build(*rest_, wanted, job); });
      RecordProperty("peak_share", std::to_string(static_cast<double>(peak) /
                                                  static_cast<double>(follicle_making_bytes(count))));
      // Parts of the candidates while they are made, and the statistics of faces.
      constexpr int64_t kBeside = 10 << 20;
      EXPECT_LE(peak, follicle_making_bytes(count) + kBeside) << count;
      EXPECT_GE(peak, follicle_making_bytes(count) * 6 / 10) << count;
      EXPECT_EQ(ledger.peak(MemoryTag::kGrooms), follicle_making_bytes(count)) << count;
      EXPECT_EQ(ledger.current(MemoryTag::kGrooms), 0);
      EXPECT_LE(static_cast<int64_t>(tree.bytes()), follicle_bytes(count) + (1 << 16));
    }
  }
}

TEST_F(GroomMemoryTest, WhatDoesNotFitIsRefusedByNameBeforeItIsMade) {
  ledger_.set_limit(64 << 20);
  const int64_t peak = peak_of([&] {
    try {
      FollicleTree::build(*rest_, options(5'000'000), job_);
      ADD_FAILURE() << "placed";
    } catch (const Error& error) {
      EXPECT_EQ(error.kind(), ErrorKind::kMemory);
      EXPECT_TRUE(std::string(error.what()).starts_with("groom 'coat': placing 5000000 strands: needs 1."))
          << error.what();
    }
  });
  EXPECT_LT(peak, 1 << 16);
}

TEST_F(GroomMemoryTest, ClumpCentresAreRefusedByNameOrChargedAsTheyAre) {
  ClumpParams params;
  params.spacing = 0.02f;  // some thirty thousand
  const int64_t peak = peak_of([&] {
    const int64_t before = static_cast<int64_t>(live_bytes());
    const Clump clump = prepared<Clump>(params, 20);
    const int64_t held = static_cast<int64_t>(live_bytes()) - before;
    EXPECT_LE(held, ledger_.current(MemoryTag::kGrooms) + (1 << 16));
    EXPECT_GE(held, ledger_.current(MemoryTag::kGrooms) * 8 / 10);
  });
  EXPECT_LE(peak, ledger_.peak(MemoryTag::kGrooms) + (10 << 20));
  EXPECT_EQ(ledger_.current(MemoryTag::kGrooms), 0);

  ledger_.set_limit(8 << 20);
  try {
    prepared<Clump>(params, 20);
    ADD_FAILURE() << "made";
  } catch (const Error& error) {
    EXPECT_EQ(error.kind(), ErrorKind::kMemory);
    EXPECT_NE(std::string(error.what()).find("clump centres (spacing 0.02)"), std::string::npos)
        << error.what();
  }
}

/// Asks to stop after so many looks.
class StopsAfterLooks final : public Progress {
 public:
  explicit StopsAfterLooks(int looks) : left_(looks) {}
  void begin(std::string_view, double) override {}
  void advance(double) override {}
  void end() override {}
  bool cancelled() const override { return --left_ < 0; }

 private:
  mutable std::atomic<int> left_;
};

TEST_F(GroomMemoryTest, PlacingStopsWhereverItIs) {
  // Placing this many looks some hundred times; each place where it looks is left by the same error.
  const Workers one(1);
  int stopped = 0, looks = 0;
  for (bool ended = false; !ended; looks += 7) {
    StopsAfterLooks progress(looks);
    try {
      FollicleTree::build(*rest_, options(30'000), Job{one, ledger_, progress});
      ended = true;
    } catch (const Error& error) {
      EXPECT_EQ(error.kind(), ErrorKind::kStopped);
      EXPECT_EQ(ledger_.current(MemoryTag::kGrooms), 0);
      ++stopped;
    }
  }
  EXPECT_GT(stopped, 20);
}

}  // namespace
}  // namespace pelage
