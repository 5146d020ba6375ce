// SPDX-License-Identifier: Apache-2.0
#include "cli/report_error.h"

#include <algorithm>

#include <gtest/gtest.h>

namespace pelage {
namespace {

TEST(ReportError, ExitCodesAreAContract) {
  EXPECT_EQ(exit_code(ErrorKind::kFailed), 1);
  EXPECT_EQ(exit_code(ErrorKind::kArguments), 2);
  EXPECT_EQ(exit_code(ErrorKind::kInput), 3);
  EXPECT_EQ(exit_code(ErrorKind::kMemory), 4);
  EXPECT_EQ(exit_code(ErrorKind::kStopped), 130);
}

TEST(ReportError, ALineEach) {
  EXPECT_EQ(error_text(Error(ErrorKind::kInput,
                             {{{"a.yaml", 2, 3}, "one"}, {{"--set a", 0, 0}, "two"}, {{}, "three"}})),
            "a.yaml:2:3: one\n--set a: two\npelage: error: three\n");
}

TEST(ReportError, ATerminalObeysNoMessage) {
  EXPECT_EQ(error_text(Error(ErrorKind::kInput, {"a\x1b[2J", 1, 1}, "got '\x1b]0;x\x07'")),
            "a\\x1b[2J:1:1: got '\\x1b]0;x\\x07'\n");
}

TEST(ReportError, VeryManyAreCounted) {
  const std::string text =
      error_text(Error(ErrorKind::kInput, std::vector<Problem>(1000, {{"a", 1, 1}, "bad"})));
  EXPECT_EQ(std::count(text.begin(), text.end(), '\n'), 51);
  EXPECT_TRUE(text.ends_with("pelage: error: and 950 more\n"));
}

}  // namespace
}  // namespace pelage
