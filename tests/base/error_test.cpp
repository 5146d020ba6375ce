// SPDX-License-Identifier: Apache-2.0
#include "base/error.h"

#include <gtest/gtest.h>

namespace pelage {
namespace {

TEST(Error, NamesThePlaceAsFarAsItIsKnown) {
  EXPECT_EQ(to_string(SourcePosition{"a.yaml", 3, 7}), "a.yaml:3:7");
  EXPECT_EQ(to_string(SourcePosition{"a.yaml", 3, 0}), "a.yaml:3");
  EXPECT_EQ(to_string(SourcePosition{"a.exr", 0, 0}), "a.exr");
  EXPECT_STREQ(Error(ErrorKind::kInput, {"a.yaml", 3, 7}, "no such key").what(), "a.yaml:3:7: no such key");
  EXPECT_STREQ(Error(ErrorKind::kFailed, "disk full").what(), "disk full");
}

TEST(Problems, AreThrownTogetherInFileOrder) {
  Problems problems;
  EXPECT_NO_THROW(problems.throw_if_any());
  problems.add({"a.yaml", 9, 1}, "late");
  problems.add({"a.yaml", 2, 1}, "early");
  problems.sort_by_line();
  try {
    problems.throw_if_any(ErrorKind::kArguments);
    FAIL();
  } catch (const Error& error) {
    EXPECT_EQ(error.kind(), ErrorKind::kArguments);
    EXPECT_EQ(error.problems().size(), 2u);
    EXPECT_STREQ(error.what(), "a.yaml:2:1: early\na.yaml:9:1: late");
  }
}

TEST(Problems, BeyondTheMostAreOnlyCounted) {
  Problems problems(2);
  for (int line = 1; line <= 5; ++line) problems.add({"a.obj", line, 0}, "wrong");
  EXPECT_EQ(problems.list().size(), 2u);
  try {
    problems.throw_if_any();
    FAIL();
  } catch (const Error& error) {
    EXPECT_NE(std::string(error.what()).find("3"), std::string::npos) << error.what();
    EXPECT_EQ(error.kind(), ErrorKind::kInput);
  }
}

}  // namespace
}  // namespace pelage
