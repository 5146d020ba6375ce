// SPDX-License-Identifier: Apache-2.0
#include "base/instruction_set.h"

#include <cstdlib>
#include <string>

#include <gtest/gtest.h>

namespace pelage {
namespace {

TEST(InstructionSet, FollowsTheProcessor) {
#if defined(__x86_64__)
  if (std::getenv("GLIBC_TUNABLES"))
    GTEST_SKIP() << "the C library may have been told to use other instructions";
  const bool fma = __builtin_cpu_supports("fma") && __builtin_cpu_supports("avx2");
  EXPECT_EQ(instruction_set(), std::string(fma ? "x86-64 FMA" : "x86-64"));
#else
  EXPECT_FALSE(std::string(instruction_set()).empty());
#endif
}

}  // namespace
}  // namespace pelage
