// SPDX-License-Identifier: Apache-2.0
#include "rib/syntax/rib_reader.h"

#include <gtest/gtest.h>

#include "tests/rib/syntax/rib_bytes_of.h"

namespace pelage::rib_reader_test {
namespace {

using namespace rib_test;

std::string failure(const std::string& bytes) {
  const std::string text = error_of([&] { statements_of(bytes); });
  return text.substr(text.find("a.rib") == std::string::npos ? 0 : text.find("a.rib"));
}

TEST(RibReader, RequestsEndWhereTheNextBegins) {
  const auto all = statements_of("WorldBegin Translate 0 0\n5 WorldEnd");
  ASSERT_EQ(all.size(), 3u);
  EXPECT_EQ(all[0].name, "WorldBegin");
  EXPECT_EQ(all[1].arguments.size(), 3u);
  EXPECT_EQ(all[1].line, 1);
  EXPECT_EQ(all[1].column, 12);
  EXPECT_EQ(all[1].arguments[2].line, 2);
  EXPECT_EQ(all[2].arguments.size(), 0u) << "arguments of the previous request are gone";
}

TEST(RibReader, AnArrayWithOneFloatIsAnArrayOfFloats) {
  const auto all = statements_of("A [1 2] [1 2.5 3] [\"a\" \"b\"] [] 7");
  ASSERT_EQ(all.size(), 1u);
  const auto& a = all[0].arguments;
  ASSERT_EQ(a.size(), 5u);
  EXPECT_EQ(a[0].integers, (std::vector<int64_t>{1, 2}));
  EXPECT_EQ(a[1].floats, (std::vector<float>{1, 2.5f, 3}));
  EXPECT_EQ(a[2].strings, (std::vector<std::string>{"a", "b"}));
  EXPECT_TRUE(a[3].is_array);
  EXPECT_EQ(a[3].size(), 0u);
  EXPECT_FALSE(a[4].is_array);
  EXPECT_EQ(a[0].describe(), "an array of 2 integers");
}

TEST(RibReader, BinaryArraysAreArrays) {
  const auto all = statements_of("A " + binary_floats({1, 2, 3}) + " 4");
  ASSERT_EQ(all.size(), 1u);
  ASSERT_EQ(all[0].arguments.size(), 2u);
  EXPECT_EQ(all[0].arguments[0].floats, (std::vector<float>{1, 2, 3}));
}

TEST(RibReader, ErrorsHavePositions) {
  EXPECT_EQ(failure("5 A"), "a.rib:1:1: expected the name of a request, got a value");
  EXPECT_EQ(failure("A [1 \"x\"]"), "a.rib:1:6: an array of numbers contains a string");
  EXPECT_EQ(failure("A [\"x\" 1]"), "a.rib:1:8: an array of strings contains a number");
  EXPECT_EQ(failure("A [1 [2]]"), "a.rib:1:6: an array within an array");
  EXPECT_EQ(failure("A [1 B"), "a.rib:1:6: an array has no closing bracket");
  EXPECT_EQ(failure("A [1"), "a.rib:1:5: an array has no closing bracket");
  EXPECT_EQ(failure("A 1 ]"), "a.rib:1:5: a closing bracket without an opening one");
  std::string many = "A";
  for (int i = 0; i < 10'001; ++i) many += " 1";
  EXPECT_EQ(failure(many), "a.rib:1:1: A: more than 10000 arguments");
}

}  // namespace
}  // namespace pelage::rib_reader_test
