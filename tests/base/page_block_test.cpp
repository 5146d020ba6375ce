// SPDX-License-Identifier: Apache-2.0
#include "base/page_block.h"

#include <cstdint>
#include <cstring>
#include <utility>

#include <gtest/gtest.h>

#include "base/heap.h"

namespace pelage {
namespace {

TEST(PageBlock, IsAlignedAndAsLargeAsItSays) {
  for (size_t bytes : {size_t(1), size_t(63), size_t(64), size_t(5000), size_t(65535), size_t(65536),
                       size_t(1) << 20, (size_t(1) << 20) + 1}) {
    PageBlock block(bytes);
    EXPECT_GE(block.bytes(), bytes);
    EXPECT_LT(block.bytes(), bytes + 4096);
    EXPECT_EQ(block.bytes(), PageBlock::held_bytes(bytes));
    EXPECT_EQ(reinterpret_cast<uintptr_t>(block.data()) % 64, 0u);
    std::memset(block.data(), 0xab, block.bytes());
  }
}

TEST(PageBlock, MovesAndMayBeEmpty) {
  PageBlock a(100000);
  const std::byte* data = a.data();
  PageBlock b = std::move(a);
  EXPECT_EQ(b.data(), data);
  EXPECT_EQ(a.data(), nullptr);  // NOLINT: what a moved-from block is
  a = std::move(b);
  EXPECT_EQ(a.data(), data);
  EXPECT_EQ(PageBlock(0).bytes(), 0u);
  EXPECT_EQ(PageBlock().data(), nullptr);
}

TEST(Heap, LargeBlocksAreWholePages) {
  EXPECT_EQ(heap_bytes(1000), 1000u);
  EXPECT_EQ(heap_bytes(kHeapPages), 2u * 4096);
  EXPECT_EQ(heap_bytes(100000) % 4096, 0u);
  EXPECT_GE(heap_bytes(100000), 100000u);
}

}  // namespace
}  // namespace pelage
