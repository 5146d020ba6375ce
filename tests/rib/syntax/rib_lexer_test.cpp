// SPDX-License-Identifier: Apache-2.0
#include "rib/syntax/rib_lexer.h"

#include <gtest/gtest.h>

#include "rib/syntax/rib_bytes.h"
#include "tests/rib/syntax/rib_bytes_of.h"

namespace pelage {
namespace {

using namespace rib_test;

// All tokens in one line of text: requests as they are, strings in quotes, numbers with their kind.
std::string tokens(const std::string& bytes) {
  const Files files;
  RibLexer lexer(files.write(bytes));
  std::string out;
  for (RibToken token = lexer.next(); token != RibToken::kEnd; token = lexer.next()) {
    out += out.empty() ? "" : " ";
    if (token == RibToken::kRequest) out += lexer.text();
    if (token == RibToken::kString) out += '"' + lexer.text() + '"';
    if (token == RibToken::kInteger) out += "i" + std::to_string(lexer.integer());
    if (token == RibToken::kFloat) out += "f" + std::to_string(lexer.number());
    if (token == RibToken::kOpen) out += "[";
    if (token == RibToken::kClose) out += "]";
    if (token == RibToken::kFloats) {
      out += "<";
      for (const float x : lexer.floats()) out += std::to_string(x) + ";";
      out += ">";
    }
  }
  return out;
}

std::string failure(const std::string& bytes) {
  std::string text = error_of([&] { tokens(bytes); });
  return text.substr(text.find("a.rib") == std::string::npos ? 0 : text.find("a.rib"));
}

TEST(RibLexer, ReadsText) {
  EXPECT_EQ(tokens("##RenderMan RIB\nTranslate 0 -5 +3 # to there\n[1 .5 1e2]\"a b\""),
            "Translate i0 i-5 i3 [ i1 f0.500000 f100.000000 ] \"a b\"");
  EXPECT_EQ(tokens("\"a\\n\\\"\\\\\\101\\\nb\""), "\"a\n\"\\Ab\"");
  EXPECT_EQ(tokens(""), "");
  EXPECT_EQ(tokens("# only a comment"), "");
  EXPECT_EQ(tokens("\xef\xbb\xbf[1]"), "[ i1 ]") << "a byte-order mark";
}

TEST(RibLexer, ReadsEveryBinaryEncoding) {
  EXPECT_EQ(tokens("\x80\xff\x81\x01\x02\x83" + big_endian(0x7fffffff, 4)), "i-1 i258 i2147483647");
  EXPECT_EQ(tokens("\x85\x01\x80"), "f1.500000") << "fixed point";
  EXPECT_EQ(tokens("\x93"
                   "abc" +
                   ("\xa0" + std::string("\x02", 1)) + "de"),
            "\"abc\" \"de\"");
  EXPECT_EQ(tokens("\xa4" + binary_float(-0.25f)), "f-0.250000");
  EXPECT_EQ(tokens("\xa5" + big_endian(0x3ff8000000000000u, 8)), "f1.500000");
  EXPECT_EQ(tokens(binary_floats({1, 2})), "<1.000000;2.000000;>");
  EXPECT_EQ(tokens(std::string("\xc8\x00", 2)), "<>");
}

TEST(RibLexer, DefinedCodesStandForRequestsAndStrings) {
  EXPECT_EQ(tokens("\xcc\x07\x95Scale\xa6\x07\xcd\x01\"P\"\xcf\x01\xa6\x07"), "Scale \"P\" Scale");
  EXPECT_EQ(tokens("\xce\x01\x02\x91P\xd0\x01\x02"), "\"P\"") << "codes of two bytes";
}

TEST(RibLexer, MixesTextAndBinary) {
  EXPECT_EQ(tokens("Translate 1 \x80\x02 3\nScale\x80\x01"), "Translate i1 i2 i3 Scale i1");
}

TEST(RibLexer, TextLineFeedsWithinBinaryDataAreNoLines) {
  EXPECT_EQ(failure("\x92\n\n ]\n  ^"), "a.rib:2:3: expected a request, a value or a parameter, got '^'");
}

TEST(RibLexer, CompressedFilesReadAlike) {
  const std::string text = "Translate 0 0 5\n\x80\x05 \"x\"";
  EXPECT_EQ(tokens(gzipped(text)), tokens(text));
  const std::string whole = gzipped(text + std::string(5000, ' ') + "Scale 1 2 3");
  EXPECT_NE(failure(whole.substr(0, whole.size() / 2)).find("damaged or cut off"), std::string::npos);
  EXPECT_NE(failure(whole.substr(0, whole.size() - 4)).find("damaged or cut off"), std::string::npos);
}

TEST(RibLexer, MarksOfEditorsAreBlanks) {
  EXPECT_EQ(tokens("\xef\xbb\xbfScale 1 2 3\r\n\x1a"), tokens("Scale 1 2 3"));
}

TEST(RibLexer, ErrorsHavePositions) {
  EXPECT_EQ(failure("Scale 1\n  2x"), "a.rib:2:3: '2x' is not a number");
  EXPECT_EQ(failure("Scale -"), "a.rib:1:7: '-' is not a number");
  EXPECT_EQ(failure("Scale nan"), "a.rib:1:7: 'nan' is not a number") << "no request";
  EXPECT_EQ(failure("Scale 1e999"), "a.rib:1:7: '1e999' is too large for a number");
  EXPECT_EQ(failure("Scale -1e999"), "a.rib:1:7: '-1e999' is too large for a number");
  EXPECT_EQ(failure("\n\"abc"), "a.rib:2:1: a string has no closing quote");
  EXPECT_EQ(failure("\xa6\x01"), "a.rib:1:1: the file uses request code 1 before it defines it");
  EXPECT_EQ(failure("\xcf\x01"), "a.rib:1:1: the file uses string code 1 before it defines it");
  EXPECT_EQ(failure("\xb0"), "a.rib:1:1: byte 176 has no meaning in a RIB file");
  EXPECT_EQ(failure("\xcc\x01 5"), "a.rib:1:1: expected the string that a code stands for");
  EXPECT_EQ(failure("a\x01"), "a.rib:1:2: expected a request, a value or a parameter, got a byte 1");
}

TEST(RibLexer, TooSmallNumbersAreZero) {
  for (const char* text : {"1e-400", "-1E-400", "+.5e-99999999999999999999", "0e-500", "4e-324"}) {
    const Files files;
    RibLexer lexer(files.write(text));
    ASSERT_EQ(lexer.next(), RibToken::kFloat) << text;
    EXPECT_EQ(static_cast<float>(lexer.number()), 0.0f) << text;
    EXPECT_EQ(lexer.next(), RibToken::kEnd) << text;
  }
}

TEST(RibLexer, CutOffBinaryDataIsAnError) {
  EXPECT_NE(failure("\x83\x01").find("ends within a binary number"), std::string::npos);
  EXPECT_NE(failure("\x95"
                    "abc")
                .find("ends within a string"),
            std::string::npos);
  EXPECT_NE(failure("\xcb" + big_endian(1'000'000, 4) + "abcd").find("ends within an array"),
            std::string::npos);
  EXPECT_EQ(failure("\xcb" + big_endian(1'000'000'001, 4)),
            "a.rib:1:1: an array claims 1000000001 numbers; the limit is 1000000000");
  EXPECT_EQ(failure("\xa3" + big_endian(0xffffffff, 4)),
            "a.rib:1:1: a string claims 4294967295 bytes; the limit is 16 MiB");
}

TEST(RibLexer, DefinitionsThatRepeatALongStringAreLimited) {
  constexpr uint32_t kLong = uint32_t(1) << 24;
  std::string bytes = std::string("\xcd\x00", 2) + "\xa3" + big_endian(kLong, 4) + std::string(kLong, 'x');
  for (const char code : {1, 2, 3}) bytes += std::string("\xcd") + code + std::string("\xcf\x00", 2);
  EXPECT_EQ(tokens(bytes), "");
  bytes += std::string("\xcd\x04\xcf\x00", 4);
  EXPECT_NE(failure(bytes).find("the strings defined for codes have more than 67108864 bytes in total"),
            std::string::npos);
}

TEST(RibLexer, RefusesWhatIsNoFile) {
  const Files files;
  EXPECT_NE(error_of([&] { RibLexer lexer(files.folder.path()); }).find("it is a folder"), std::string::npos);
  EXPECT_NE(error_of([&] { RibLexer lexer(files.folder.path() / "none.rib"); }).find("cannot read"),
            std::string::npos);
  EXPECT_NE(error_of([&] {
              RibLexer lexer(files.write("version https://git-lfs.github.com/spec/v1\n"));
            }).find("git-lfs"),
            std::string::npos);
  EXPECT_NE(error_of([&] { RibLexer lexer(files.write(std::string("\xff\xfe#\0", 4))); }).find("UTF-16"),
            std::string::npos);
}

// A file of 70 kB, of which gzip makes 70 MB.
TEST(RibLexer, FilesThatExpandTooMuchAreErrors) {
  const Files files;
  const std::string block(size_t(1) << 20, ' ');
  std::string text = "version 3 ";
  for (int i = 0; i < 63; ++i) text += block;
  const auto end_of = [&](const std::string& bytes) {
    RibLexer lexer(files.write(bytes));
    while (lexer.next() != RibToken::kEnd) {
    }
  };
  end_of(gzipped(text));
  text += block + block;
  EXPECT_NE(error_of([&] { end_of(gzipped(text)); }).find("a.rib:1:"), std::string::npos);
  EXPECT_NE(error_of([&] { end_of(gzipped(text)); }).find("more than 200 times its size"), std::string::npos);
  end_of(text);  // not compressed
}

}  // namespace
}  // namespace pelage
