// SPDX-License-Identifier: Apache-2.0
#include "base/stoppable_sort.h"

#include <algorithm>
#include <functional>
#include <vector>

#include <gtest/gtest.h>

#include "base/error.h"
#include "base/hash.h"
#include "tests/support/quiet_job.h"

namespace pelage {
namespace {

std::vector<uint64_t> numbers(size_t count) {
  std::vector<uint64_t> result(count);
  for (size_t i = 0; i < count; ++i) result[i] = hash64(1, i, 2) % std::max<size_t>(count / 2, 1);
  return result;
}

class Stopped final : public Progress {
 public:
  void begin(std::string_view, double) override {}
  void advance(double) override {}
  void end() override {}
  bool cancelled() const override { return true; }
};

TEST(StoppableSort, SortsAsTheLibraryDoes) {
  for (const int threads : {1, 3}) {
    QuietJob job(threads);
    for (const size_t count : {0, 1, 100, 16383, 16384, 100'003}) {
      std::vector<uint64_t> sorted = numbers(count), truth = sorted;
      stoppable_sort(job, sorted.begin(), sorted.end(), std::greater<>());
      std::sort(truth.begin(), truth.end(), std::greater<>());
      EXPECT_EQ(sorted, truth) << count;
    }
  }
}

TEST(StoppableSort, OrdersEqualElementsAlikeWithAnyNumberOfThreads) {
  std::vector<std::vector<uint64_t>> sorted;
  for (const int threads : {1, 2, 5}) {
    QuietJob job(threads);
    sorted.push_back(numbers(50'000));
    stoppable_sort(job, sorted.back().begin(), sorted.back().end(),
                   [](uint64_t a, uint64_t b) { return a % 100 < b % 100; });
  }
  EXPECT_EQ(sorted[0], sorted[1]);
  EXPECT_EQ(sorted[0], sorted[2]);
}

TEST(StoppableSort, EndsWhenTheUserAsksToStop) {
  const Workers workers(1);
  MemoryLedger ledger;
  Stopped stopped;
  const Job job{workers, ledger, stopped};
  std::vector<uint64_t> few = numbers(100), many = numbers(30000);
  EXPECT_NO_THROW(stoppable_sort(job, few.begin(), few.end(), std::less<>())) << "it asks now and then";
  try {
    stoppable_sort(job, many.begin(), many.end(), std::less<>());
    FAIL();
  } catch (const Error& error) {
    EXPECT_EQ(error.kind(), ErrorKind::kStopped);
  }
}

}  // namespace
}  // namespace pelage
