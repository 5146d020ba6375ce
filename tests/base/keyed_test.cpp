// SPDX-License-Identifier: Apache-2.0
#include "base/keyed.h"

#include <gtest/gtest.h>

#include "tests/support/parsed_value.h"

namespace pelage::keyed_test {
namespace {

std::vector<std::string> problems_of(const Value& value) {
  Keyed<float> out(7.0f);
  Problems problems;
  const bool good = ValueReader<Keyed<float>>::read(value, {.min = 0}, out, problems);
  EXPECT_EQ(good, problems.empty());
  std::vector<std::string> messages;
  for (const Problem& problem : problems.list()) messages.push_back(problem.message);
  if (!good) {
    EXPECT_EQ(out.at(0), 7.0f) << "a value that could not be read left its mark";
  }
  return messages;
}
using Lines = std::vector<std::string>;

template <class T>
Keyed<T> read(const Value& value) {
  Keyed<T> out;
  Problems problems;
  EXPECT_TRUE(ValueReader<Keyed<T>>::read(value, {}, out, problems));
  return out;
}

Value keys(std::vector<std::pair<std::string, Value>> entries) {
  return block({{"keys", block(std::move(entries))}});
}

TEST(Keyed, AConstantIsTheSameAtAllTimes) {
  const auto value = read<float>(scalar("3"));
  EXPECT_TRUE(value.is_constant());
  EXPECT_EQ(value.at(-100), 3.0f);
  EXPECT_EQ(value.at(100), 3.0f);
}

TEST(Keyed, IsLinearBetweenKeysAndConstantOutside) {
  const auto value = read<float>(keys({{"11", scalar("20")}, {"1", scalar("10")}, {"-9.5", scalar("0")}}));
  EXPECT_FALSE(value.is_constant());
  EXPECT_EQ(value.at(-20), 0.0f);
  EXPECT_EQ(value.at(-9.5), 0.0f);
  EXPECT_EQ(value.at(1), 10.0f);
  EXPECT_EQ(value.at(6), 15.0f);
  EXPECT_EQ(value.at(11), 20.0f);
  EXPECT_EQ(value.at(50), 20.0f);
}

TEST(Keyed, HoldsVectors) {
  const auto value = read<V3f>(keys({{"0", numbers({"0", "0", "0"})}, {"2", numbers({"2", "4", "6"})}}));
  EXPECT_EQ(value.at(1), V3f(1, 2, 3));
}

TEST(Keyed, MistakesAreReported) {
  EXPECT_EQ(problems_of(scalar("x")), Lines{"expected a number >= 0, got 'x'"});
  EXPECT_EQ(problems_of(keys({{"1", scalar("-1")}, {"2", scalar("x")}})),
            (Lines{"expected a number >= 0, got -1", "expected a number >= 0, got 'x'"}));
  EXPECT_EQ(problems_of(keys({{"one", scalar("1")}})), Lines{"expected a frame number, got 'one'"});
  EXPECT_EQ(problems_of(keys({{"1", scalar("1")}, {"1.0", scalar("2")}})), Lines{"frame 1 has two values"});
  EXPECT_EQ(problems_of(keys({})),
            Lines{"expected a map from frames to values, {1: a, 48: b}, got a block of 0 keys"});
  EXPECT_EQ(problems_of(block({{"keys", scalar("1")}})),
            Lines{"expected a map from frames to values, {1: a, 48: b}, got '1'"});
  EXPECT_EQ(problems_of(block({{"kyes", scalar("1")}})),
            Lines{"unknown key 'kyes' in a value with keys; did you mean 'keys'?"});
  EXPECT_EQ(problems_of(block({})), Lines{"expected {keys: {frame: value, ...}}, got {}"});
}

}  // namespace
}  // namespace pelage::keyed_test
