// SPDX-License-Identifier: Apache-2.0
#include "base/check.h"

#include <gtest/gtest.h>

namespace pelage {
namespace {

TEST(CheckDeathTest, BrokenInvariantStopsTheProgramAndSaysWhichAndWhere) {
  GTEST_FLAG_SET(death_test_style, "threadsafe");
  const int strands = -1;
  EXPECT_DEATH(PELAGE_CHECK(strands >= 0),
               "internal error: .*check_test.cpp:[0-9]+: check failed: strands >= 0");
}

TEST(Check, WhatHoldsIsEvaluatedOnceAndPasses) {
  int evaluations = 0;
  PELAGE_CHECK(++evaluations == 1);
  EXPECT_EQ(evaluations, 1);
}

}  // namespace
}  // namespace pelage
