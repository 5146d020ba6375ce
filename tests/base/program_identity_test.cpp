// SPDX-License-Identifier: Apache-2.0
#include "base/program_identity.h"

#include <cstdlib>
#include <string>

#include <gtest/gtest.h>

namespace pelage {
namespace {

TEST(ProgramIdentity, IsThereAndStays) {
  const std::string identity = program_identity();
  EXPECT_GE(identity.size(), 8u);
  EXPECT_EQ(program_identity(), identity);
}

TEST(ProgramIdentity, ArithmeticIdentityNamesTheLibraryOfFunctions) {
  EXPECT_NE(arithmetic_identity().find(library_identity("libm.so")), std::string::npos);
  EXPECT_EQ(arithmetic_identity(), arithmetic_identity());
}

TEST(ProgramIdentity, LibrariesAreFoundByAPartOfTheirName) {
  const std::string library = library_identity("libstdc++");
  EXPECT_NE(library, "none");
  EXPECT_NE(library, program_identity());
  EXPECT_EQ(library_identity("libstdc++.so"), library);
  EXPECT_EQ(library_identity("no-such-library"), "none");
}

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
