// SPDX-License-Identifier: Apache-2.0
#include "render/gather/index_table.h"

#include <unordered_map>

#include <gtest/gtest.h>

#include "base/hash.h"

namespace pelage {
namespace {

TEST(IndexTable, NumbersKeysInTheOrderOfTheirFirstUse) {
  IndexTable table;
  for (int round = 0; round < 2; ++round) {
    std::unordered_map<uint64_t, uint32_t> expected;
    for (uint64_t i = 0; i < 20000; ++i) {
      const uint64_t key = hash64(i * i % 4999, round);
      const uint32_t index = expected.try_emplace(key, static_cast<uint32_t>(expected.size())).first->second;
      ASSERT_EQ(table.index(key), index) << i;
    }
    EXPECT_EQ(table.size(), expected.size());
    table.clear();
    EXPECT_EQ(table.size(), 0u);
  }
}

TEST(IndexTable, TellsKeysInTheSameSlotApart) {
  IndexTable table;
  for (uint32_t i = 0; i < 100; ++i) EXPECT_EQ(table.index(uint64_t{i} << 40), i) << "low bits are equal";
  for (uint32_t i = 0; i < 100; ++i) EXPECT_EQ(table.index(uint64_t{i} << 40), i);
  EXPECT_EQ(table.index(0), 0u) << "0 is a key like others";
}

}  // namespace
}  // namespace pelage
