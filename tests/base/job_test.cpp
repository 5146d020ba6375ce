// SPDX-License-Identifier: Apache-2.0
#include "base/job.h"

#include <atomic>

#include <gtest/gtest.h>

#include "base/error.h"

namespace pelage {
namespace {

/// Asks to stop after this many ranges.
class StopsAfter final : public Progress {
 public:
  explicit StopsAfter(int count) : left_(count) {}
  void begin(std::string_view, double) override {}
  void advance(double) override { --left_; }
  void end() override {}
  bool cancelled() const override { return left_ <= 0; }

 private:
  std::atomic<int> left_;
};

TEST(Job, LoopsRunToTheirEndWhereNobodyStopsThem) {
  const Workers workers(2);
  MemoryLedger ledger;
  NoProgress progress;
  std::atomic<size_t> sum{0};
  Job{workers, ledger, progress}.for_each(100, 7, [&](WorkRange range) {
    for (size_t i = range.begin; i < range.end; ++i) sum += i;
  });
  EXPECT_EQ(sum, 4950u);
}

TEST(Job, ALoopThatIsStoppedHandsOutNoFurtherRange) {
  const Workers workers(2);
  MemoryLedger ledger;
  StopsAfter progress(3);
  const Job job{workers, ledger, progress};
  std::atomic<int> ranges{0};
  try {
    job.for_each(1000, 1, [&](WorkRange) {
      ++ranges;
      progress.advance(1);
    });
    FAIL();
  } catch (const Error& error) {
    EXPECT_EQ(error.kind(), ErrorKind::kStopped);
  }
  EXPECT_LE(ranges, 3 + 2);  // the ranges that threads held when it was stopped end first
  EXPECT_THROW(job.check_stop(), Error);
}

}  // namespace
}  // namespace pelage
