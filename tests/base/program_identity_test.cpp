// SPDX-License-Identifier: Apache-2.0
#include "base/program_identity.h"

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

}  // namespace
}  // namespace pelage
