// SPDX-License-Identifier: Apache-2.0
#include "cli/lab_program.h"

#include <sstream>

#include <gtest/gtest.h>

#include "base/error.h"

namespace pelage {
namespace {

TEST(LabProgram, HasTwoCommands) {
  EXPECT_TRUE(is_lab_command({"measure", "bounds", "a.yaml"}));
  EXPECT_TRUE(is_lab_command({"compare"}));
  EXPECT_FALSE(is_lab_command({"render", "measure"}));
  EXPECT_FALSE(is_lab_command({"--help"}));
  EXPECT_FALSE(is_lab_command({}));
}

TEST(LabProgram, IsMissedInOneLine) {
  const std::string how =
      "`measure` needs the program pelage-lab, which is not in /no/such; `./dev build` builds it and `cmake "
      "--install build/release` installs it, see docs/MEASURE.md";
  std::ostringstream out;
  try {
    start_lab("/no/such/pelage-lab", {"measure", "bounds", "a.yaml"}, out);
    FAIL();
  } catch (const Error& error) {
    EXPECT_EQ(error.kind(), ErrorKind::kFailed);
    EXPECT_EQ(error.what(), how);
  }
  EXPECT_EQ(out.str(), "");
  for (const char* flag : {"--help", "-h"}) {
    std::ostringstream help;
    EXPECT_EQ(start_lab("/no/such/pelage-lab", {"measure", flag}, help), 0);
    EXPECT_EQ(help.str().substr(0, 19), "Run one experiment,");
    EXPECT_NE(help.str().find(how), std::string::npos);
  }
}

}  // namespace
}  // namespace pelage
