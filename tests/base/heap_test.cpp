// SPDX-License-Identifier: Apache-2.0
#include "base/heap.h"

#include <cstdlib>
#include <vector>

#include <gtest/gtest.h>

#include "tests/support/effort.h"

#if defined(__GLIBC__)
#include <malloc.h>
#endif

namespace pelage {
namespace {

#if defined(__GLIBC__) && !PELAGE_SANITIZED

constexpr size_t kBlock = size_t{64} << 10;  // a typical array of a chunk
constexpr size_t kBlocks = 64;               // more than fit at the end of a fresh heap

enum Pages { kShared, kOwn, kMixed };

/// Whether many blocks have pages of their own. Two may fit into what the heap has already.
Pages pages_of_blocks() {
  const size_t before = mallinfo2().hblks;
  std::vector<void*> blocks(kBlocks);
  for (void*& block : blocks) block = std::malloc(kBlock);
  const size_t after = mallinfo2().hblks;
  for (void* block : blocks) std::free(block);
  if (after == before) return kShared;
  return after - before >= kBlocks - 2 ? kOwn : kMixed;
}

// The settings of the heap cannot be taken back, so each case runs in a process of its own.
TEST(HeapDeathTest, BlocksHavePagesOfTheirOwnUnlessMemoryIsPlenty) {
  GTEST_FLAG_SET(death_test_style, "threadsafe");
  const auto run = [](size_t limit) {
    keep_heap_small();
    if (limit != 1) keep_spare_heap(limit, 2);
    std::exit(pages_of_blocks());
  };
  constexpr size_t kGiB = size_t{1} << 30;
  EXPECT_EXIT(run(1), testing::ExitedWithCode(kOwn), "") << "without the call";
  EXPECT_EXIT(run(kGiB - 1), testing::ExitedWithCode(kOwn), "");
  EXPECT_EXIT(run(kGiB), testing::ExitedWithCode(kShared), "");
  EXPECT_EXIT(run(0), testing::ExitedWithCode(kShared), "");
  const auto run_twice = [&] {
    keep_spare_heap(0, 2);
    run(kGiB - 1);
  };
  EXPECT_EXIT(run_twice(), testing::ExitedWithCode(kOwn), "") << "a smaller limit later";
}

#endif

}  // namespace
}  // namespace pelage
