// SPDX-License-Identifier: Apache-2.0
#include "base/memory_budget.h"

#include <gtest/gtest.h>

#include "base/error.h"

namespace pelage {
namespace {

TEST(MemoryBudget, TextIsNotRoundedToAnotherSize) {
  EXPECT_EQ(memory_text(1), "1 byte");
  EXPECT_EQ(memory_text(1500), "1500 bytes");
  EXPECT_EQ(memory_text(640 << 10), "640 KiB");
  EXPECT_EQ(memory_text((22 << 20) + (7 << 20) / 10), "22.7 MiB");
  EXPECT_EQ(memory_text(int64_t{3} << 29), "1.5 GiB");
}

TEST(MemoryBudget, WithoutALimitEverythingFits) {
  const MemoryLedger ledger;
  EXPECT_NO_THROW(require_memory(ledger, int64_t{1} << 60, "a mountain"));
  EXPECT_TRUE(has_room(ledger, int64_t{1} << 60));
}

TEST(MemoryBudget, RefusalNamesTheThingWhatIsInUseAndWhatWouldDo) {
  MemoryLedger ledger;
  ledger.set_limit(64 << 20);
  const MemoryCharge skins(ledger, MemoryTag::kSkins, 30 << 20);
  const MemoryCharge textures(ledger, MemoryTag::kTextures, 10 << 20);
  const MemoryCharge libraries(ledger, MemoryTag::kLibraries, 100 << 20);  // not of the budget
  EXPECT_NO_THROW(require_memory(ledger, 24 << 20, "groom 'coat'"));
  EXPECT_TRUE(has_room(ledger, 24 << 20));
  EXPECT_FALSE(has_room(ledger, (24 << 20) + 1));
  try {
    require_memory(ledger, 25 << 20, "placing 5000 strands of groom 'coat'");
    FAIL();
  } catch (const Error& error) {
    EXPECT_EQ(error.kind(), ErrorKind::kMemory);
    EXPECT_STREQ(error.what(),
                 "placing 5000 strands of groom 'coat' needs 25.0 MiB, but render.memory is 64.0 MiB and "
                 "40.0 MiB are in use (skins 30.0 MiB, textures 10.0 MiB); give at least --memory 66M");
  }
}

TEST(MemoryBudget, ReservesOnlyWhatFits) {
  MemoryLedger ledger;
  ledger.set_limit(1 << 20);
  {
    const MemoryCharge held = reserve(ledger, MemoryTag::kGrooms, 1 << 20, "all of it");
    EXPECT_EQ(ledger.current(MemoryTag::kGrooms), 1 << 20);
    EXPECT_THROW(reserve(ledger, MemoryTag::kFilm, 1, "one byte"), Error);
    EXPECT_EQ(ledger.current(MemoryTag::kFilm), 0);
  }
  EXPECT_EQ(ledger.budgeted(), 0);
}

}  // namespace
}  // namespace pelage
