// SPDX-License-Identifier: Apache-2.0
#include "base/visible_text.h"

#include <gtest/gtest.h>

namespace pelage::visible_text_test {
namespace {

TEST(VisibleText, ControlCharactersAreShown) {
  EXPECT_EQ(visible("\x1b]0;title\x07 \x1b[2J\rover\x7f"), "\\x1b]0;title\\x07 \\x1b[2J\\x0dover\\x7f");
  EXPECT_EQ(visible(std::string_view("a\0b", 3)), "a\\x00b");
  EXPECT_EQ(visible("two\tcolumns\nand lines"), "two\tcolumns\nand lines");
}

TEST(VisibleText, OtherCharactersStay) {
  const std::string text = "Fell \xc3\xa4\xc3\x80 \xe2\x82\xac \xf0\x9f\x90\x80 \xc2\xa0.";
  EXPECT_EQ(visible(text), text);
}

TEST(VisibleText, ControlCharactersBeyondAsciiAreShownToo) {
  EXPECT_EQ(visible("\xc2\x9b"
                    "2J"),
            "\\xc2\\x9b"
            "2J");  // U+009B begins a sequence like ESC [
  EXPECT_EQ(visible("a\x9b"
                    "2J"),
            "a\\x9b"
            "2J");  // in an 8-bit encoding
  EXPECT_EQ(visible("\xc3\xa4\x9b"), "\xc3\xa4\\x9b");
}

}  // namespace
}  // namespace pelage::visible_text_test
