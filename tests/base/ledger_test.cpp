// SPDX-License-Identifier: Apache-2.0
#include "base/ledger.h"

#include <set>
#include <string>
#include <utility>

#include <gtest/gtest.h>

#include "base/parallel.h"

namespace pelage {
namespace {

TEST(MemoryTag, EveryTagHasANameOfItsOwn) {
  std::set<std::string> names;
  for (int tag = 0; tag < static_cast<int>(MemoryTag::kCount); ++tag) {
    names.insert(std::string(memory_tag_name(static_cast<MemoryTag>(tag))));
  }
  EXPECT_EQ(names.size(), static_cast<size_t>(MemoryTag::kCount));
  EXPECT_FALSE(names.contains("unknown"));
  // The names of design and statistics.
  for (const char* name :
       {"chunks", "skins", "operator_cache", "reflection_cache", "film", "textures", "libraries"}) {
    EXPECT_TRUE(names.contains(name)) << name;
  }
}

TEST(MemoryLedger, KeepsPeaksPerTag) {
  MemoryLedger ledger;
  ledger.charge(MemoryTag::kChunks, 100);
  ledger.charge(MemoryTag::kChunks, 50);
  ledger.charge(MemoryTag::kChunks, -120);
  ledger.charge(MemoryTag::kFilm, 7);
  EXPECT_EQ(ledger.current(MemoryTag::kChunks), 30);
  EXPECT_EQ(ledger.peak(MemoryTag::kChunks), 150);
  EXPECT_EQ(ledger.peak(MemoryTag::kFilm), 7);
  EXPECT_EQ(ledger.peak(MemoryTag::kSkins), 0);
}

TEST(MemoryCharge, HoldsForItsLifeAndFollowsMoves) {
  MemoryLedger ledger;
  {
    MemoryCharge outer;
    {
      MemoryCharge inner(ledger, MemoryTag::kSkins, 40);
      outer = std::move(inner);
    }
    EXPECT_EQ(ledger.current(MemoryTag::kSkins), 40);
    const MemoryCharge moved(std::move(outer));
    EXPECT_EQ(ledger.current(MemoryTag::kSkins), 40);
  }
  EXPECT_EQ(ledger.current(MemoryTag::kSkins), 0);
  EXPECT_EQ(ledger.peak(MemoryTag::kSkins), 40);
}

TEST(MemoryCharge, AssignedOverGivesBackWhatItHeld) {
  MemoryLedger ledger;
  MemoryCharge charge(ledger, MemoryTag::kSkins, 40);
  charge = MemoryCharge(ledger, MemoryTag::kSkins, 5);
  EXPECT_EQ(ledger.current(MemoryTag::kSkins), 5);
}

TEST(MemoryLedger, LosesNothingBetweenThreads) {
  MemoryLedger ledger;
  const Workers workers(4);
  workers.for_each(20'000, 16, [&](WorkRange range) {
    for (size_t i = range.begin; i < range.end; ++i) {
      const MemoryCharge passing(ledger, MemoryTag::kChunks, 1000);
      ledger.charge(MemoryTag::kFilm, 1);
    }
  });
  EXPECT_EQ(ledger.current(MemoryTag::kChunks), 0);
  EXPECT_GE(ledger.peak(MemoryTag::kChunks), 1000);
  EXPECT_LE(ledger.peak(MemoryTag::kChunks), 4000);
  EXPECT_EQ(ledger.peak(MemoryTag::kFilm), 20'000);
}

}  // namespace
}  // namespace pelage
