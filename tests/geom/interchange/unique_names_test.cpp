// SPDX-License-Identifier: Apache-2.0
#include "geom/interchange/unique_names.h"

#include <gtest/gtest.h>

namespace pelage {
namespace {

TEST(UniqueNames, IdentifiersHaveOnlyLettersDigitsAndUnderscores) {
  EXPECT_EQ(identifier("Long_hair2"), "Long_hair2");
  EXPECT_EQ(identifier("cat.under coat"), "cat_under_coat");
  EXPECT_EQ(identifier("2nd"), "_2nd");
  EXPECT_EQ(identifier(""), "_");
  EXPECT_EQ(identifier("\xc3\xa9"), "__") << "two bytes of UTF-8";
}

TEST(UniqueNames, NoTwoAreEqual) {
  UniqueNames names;
  EXPECT_EQ(names.unique("a b"), "a_b");
  EXPECT_EQ(names.unique("a.b"), "a_b_2");
  EXPECT_EQ(names.unique("a_b_2"), "a_b_2_2");
  EXPECT_EQ(names.unique("a.b"), "a_b_3");
  EXPECT_EQ(UniqueNames().unique("a b"), "a_b") << "of another parent";
}

}  // namespace
}  // namespace pelage
