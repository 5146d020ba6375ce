// SPDX-License-Identifier: Apache-2.0
#include "base/page_pool.h"

#include <algorithm>
#include <cerrno>
#include <cstdint>
#include <cstring>
#include <utility>
#include <vector>

#include <gtest/gtest.h>
#include <sys/mman.h>
#include <unistd.h>

#include "base/hash.h"
#include "base/parallel.h"

namespace pelage {
namespace {

TEST(PagePool, BlocksAreAsThoseOfTheSystem) {
  PagePool pool;
  for (size_t bytes : {size_t(0), size_t(1), size_t(5000), size_t(65535), size_t(65536), size_t(1) << 20,
                       (size_t(1) << 20) + 1, size_t(40) << 20}) {
    PageBlock block = pool.take(bytes);
    EXPECT_EQ(block.bytes(), PageBlock::held_bytes(bytes));
    EXPECT_EQ(reinterpret_cast<uintptr_t>(block.data()) % 64, 0u);
    if (bytes > 0) std::memset(block.data(), 0xab, block.bytes());
    PageBlock moved = std::move(block);
    EXPECT_EQ(moved.bytes(), PageBlock::held_bytes(bytes));
  }
}

TEST(PagePool, NeighboursShareAPiece) {
  PagePool pool;
  const PageBlock a = pool.take(100000), b = pool.take(100000);
  EXPECT_EQ(b.data() - a.data(), static_cast<std::ptrdiff_t>(a.bytes()));
}

// The memory of a freed block is free again, wherever it was, and is merged with free neighbours.
TEST(PagePool, RoomIsUsedAgain) {
  PagePool pool;
  const size_t bytes = size_t(1) << 20;
  std::vector<PageBlock> blocks;
  for (int i = 0; i < 4; ++i) blocks.push_back(pool.take(bytes));
  std::byte* second = blocks[1].data();
  blocks[1] = PageBlock();
  blocks[2] = PageBlock();
  EXPECT_EQ(pool.take(2 * bytes).data(), second);
  EXPECT_EQ(pool.take(bytes / 2).data(), second);
  const PageBlock after = pool.take(3 * bytes);
  EXPECT_GT(after.data(), blocks[3].data());
}

// How many bytes of [data, data + bytes) are resident: the process as a whole says less, since a sanitizer
// keeps notes of its own for each byte.
size_t resident_bytes(const std::byte* data, size_t bytes) {
  const auto page = static_cast<size_t>(::sysconf(_SC_PAGESIZE));
  const auto address = reinterpret_cast<uintptr_t>(data);
  const uintptr_t first = address / page * page;
  std::vector<unsigned char> pages((address + bytes - first + page - 1) / page);
  if (::mincore(reinterpret_cast<void*>(first), pages.size() * page, pages.data()) != 0) {
    ADD_FAILURE() << "mincore: " << std::strerror(errno);
    return 0;
  }
  return page * static_cast<size_t>(
                    std::count_if(pages.begin(), pages.end(), [](unsigned char p) { return p & 1; }));
}

TEST(PagePool, GivesMemoryBackAtOnce) {
  PagePool pool;
  const size_t bytes = size_t(8) << 20;
  const std::byte* data = nullptr;
  {
    PageBlock block = pool.take(bytes);
    data = block.data();
    std::memset(block.data(), 1, bytes);
    EXPECT_GE(resident_bytes(data, bytes), bytes);
  }
  EXPECT_EQ(resident_bytes(data, bytes), 0u);
}

// Blocks never overlap, whatever lives and dies beside them, on whatever thread.
TEST(PagePool, BlocksKeepWhatWasWritten) {
  PagePool pool;
  Workers(4).for_each(4, 1, [&](WorkRange range) {
    std::vector<std::pair<PageBlock, int>> blocks;
    const auto is_whole = [](const std::pair<PageBlock, int>& of) {
      const std::byte* data = of.first.data();
      const auto mark = static_cast<std::byte>(of.second);
      return data[0] == mark && data[of.first.bytes() / 2] == mark && data[of.first.bytes() - 1] == mark;
    };
    for (uint64_t i = 0; i < 400; ++i) {
      const uint64_t random = hash64(range.begin, i);
      if (random % 3 == 0 && !blocks.empty()) {
        const size_t which = (random >> 8) % blocks.size();
        EXPECT_TRUE(is_whole(blocks[which]));
        std::swap(blocks[which], blocks.back());
        blocks.pop_back();
        continue;
      }
      const int mark = static_cast<int>(random >> 16 & 0x7f);
      blocks.emplace_back(pool.take(1000 + (random >> 24) % 400000), mark);
      std::memset(blocks.back().first.data(), mark, blocks.back().first.bytes());
    }
    for (const auto& block : blocks) EXPECT_TRUE(is_whole(block));
  });
}

}  // namespace
}  // namespace pelage
