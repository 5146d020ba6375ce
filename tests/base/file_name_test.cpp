// SPDX-License-Identifier: Apache-2.0
#include "base/file_name.h"

#include <set>

#include <gtest/gtest.h>

namespace pelage::file_name_test {
namespace {

TEST(FileName, PlainNamesStayReadable) {
  EXPECT_EQ(file_name_of({"rat", "under_coat-2", "3"}), "rat.under_coat-2.3");
  EXPECT_EQ(file_name_of({"colony.17", "Fell ä"}), "colony=2E17.Fell=20=C3=A4");
}

TEST(FileName, DifferentPartsHaveDifferentNames) {
  std::set<std::string> names;
  size_t count = 0;
  const std::vector<std::string> words{"",        ".",   "..",  "a",  "a.b",      "b.c",
                                       "b",       "/",   "a/b", "=",  "==",       "=2F",
                                       "A",       "-",   "-a",  "a-", "\\",       "%2F",
                                       "a b",     "\n",  "~",   "*",  "\xff",     std::string("a\0b", 3),
                                       "a.b.c.d", "con", ":",   "é",  "e\xcc\x81"};
  for (const std::string& a : words) {
    ++count;
    names.insert(file_name_of({a}));
    for (const std::string& b : words) {
      ++count;
      names.insert(file_name_of({a, b}));
      for (const std::string& c : words) {
        ++count;
        names.insert(file_name_of({a, b, c}));
      }
    }
  }
  EXPECT_EQ(names.size(), count);
}

TEST(FileName, CannotLeaveItsFolder) {
  for (const std::string& hostile :
       {std::string(""), std::string("."), std::string(".."), std::string("../../x"),
        std::string("/etc/passwd"), std::string("-rf"), std::string("~root"), std::string("a\0/b", 4),
        std::string(5000, '.'), std::string(5000, '/')}) {
    for (const std::vector<std::string>& parts :
         {std::vector{hostile}, {hostile, hostile}, {"", "", hostile}}) {
      const std::string name = file_name_of(parts);
      EXPECT_EQ(name.find_first_of(std::string("/\0\\", 3)), std::string::npos) << name;
      EXPECT_NE(name.front(), '.');
      EXPECT_NE(name.front(), '-');
      EXPECT_LE(name.size(), 120u);
    }
  }
}

TEST(FileName, LongNamesAreCutAndStillDiffer) {
  const std::string one = file_name_of({std::string(300, 'a') + "1"}),
                    two = file_name_of({std::string(300, 'a') + "2"});
  EXPECT_EQ(one.size(), 114u);
  EXPECT_NE(one, two);
  EXPECT_EQ(one.substr(0, 80), two.substr(0, 80));
  EXPECT_EQ(file_name_of({std::string(120, 'a')}), std::string(120, 'a'));
}

}  // namespace
}  // namespace pelage::file_name_test
