// SPDX-License-Identifier: Apache-2.0
#include "base/value.h"

#include <gtest/gtest.h>

#include "tests/support/parsed_value.h"

namespace pelage {
namespace {

TEST(Value, KnowsItsKind) {
  EXPECT_TRUE(Value().is_null());
  EXPECT_TRUE(scalar("x").is_scalar());
  EXPECT_TRUE(list({}).is_list());
  EXPECT_TRUE(block({}).is_map());
}

TEST(Value, FindsKeys) {
  Value value = block({{"a", scalar("1")}, {"b", scalar("2")}});
  ASSERT_NE(value.find("b"), nullptr);
  EXPECT_EQ(value.find("b")->text(), "2");
  EXPECT_EQ(value.find("c"), nullptr);
  EXPECT_EQ(scalar("a").find("a"), nullptr);
}

TEST(Value, DescribesItselfInOneShortLine) {
  EXPECT_EQ(Value().describe(), "nothing");
  EXPECT_EQ(scalar("abc").describe(), "'abc'");
  EXPECT_EQ(list({scalar("1"), scalar("2")}).describe(), "a list of 2");
  EXPECT_EQ(block({{"a", scalar("1")}}).describe(), "a block of 1 key");
  EXPECT_EQ(block({}).describe(), "a block of 0 keys");
  EXPECT_EQ(scalar("two\nlines\x1b[31m").describe(), "'two?lines?[31m'");
  EXPECT_EQ(scalar(std::string(1000, 'x')).describe(), "'" + std::string(40, 'x') + "...'");
}

TEST(SourcePosition, PrintsWhatIsKnown) {
  EXPECT_EQ(to_string(SourcePosition{"a.yaml", 3, 7}), "a.yaml:3:7");
  EXPECT_EQ(to_string(SourcePosition{"a.obj", 3, 0}), "a.obj:3");
  EXPECT_EQ(to_string(SourcePosition{"--set a.b", 0, 0}), "--set a.b");
  EXPECT_EQ(to_string(SourcePosition{}), "");
}

TEST(Problems, AreThrownTogether) {
  Problems problems;
  EXPECT_NO_THROW(problems.throw_if_any());
  problems.add({"a", 1, 2}, "first");
  problems.add({}, "second");
  try {
    problems.throw_if_any();
    FAIL() << "nothing was thrown";
  } catch (const Error& error) {
    EXPECT_STREQ(error.what(), "a:1:2: first\nsecond");
    EXPECT_EQ(error.kind(), ErrorKind::kInput);
  }
}

}  // namespace
}  // namespace pelage
