// SPDX-License-Identifier: Apache-2.0
#include "base/value_readers.h"

#include <gtest/gtest.h>

#include "tests/support/parsed_value.h"

namespace pelage::value_readers_test {
namespace {

enum class Shape { kBox, kRoundBox };

}  // namespace

}  // namespace pelage::value_readers_test

template <>
struct pelage::EnumNames<pelage::value_readers_test::Shape> {
  static constexpr const char* names[] = {"box", "round-box"};
};

namespace pelage::value_readers_test {
namespace {

// The one problem of reading a T, or "" when there is none.
template <class T>
std::string problem_of(const Value& value, const KeyOptions& options = {}) {
  T out{};
  Problems problems;
  const bool good = ValueReader<T>::read(value, options, out, problems);
  EXPECT_EQ(good, problems.empty());
  EXPECT_LE(problems.list().size(), 1u);
  return problems.empty() ? "" : problems.list()[0].message;
}

template <class T>
T read(const Value& value, const KeyOptions& options = {}) {
  T out{};
  Problems problems;
  EXPECT_TRUE(ValueReader<T>::read(value, options, out, problems));
  for (const Problem& problem : problems.list()) ADD_FAILURE() << problem.message;
  return out;
}

TEST(ValueReaders, Numbers) {
  EXPECT_EQ(read<double>(scalar("1")), 1.0);
  EXPECT_EQ(read<double>(scalar("-2.5e-3")), -2.5e-3);
  EXPECT_EQ(read<double>(scalar("+.5")), 0.5);
  EXPECT_EQ(read<double>(scalar("1_000_000.5")), 1000000.5);
  EXPECT_EQ(read<float>(scalar("0.1")), 0.1f);
  for (const char* text : {"", "abc", "1a", "0x10", "nan", ".nan", "inf", ".inf", "1e999", "1__0", "_1", "1_",
                           "--1", "+-1", "1,5", " 1", "1e", "infinity", "."}) {
    EXPECT_EQ(problem_of<double>(scalar(text)), "expected a number, got '" + std::string(text) + "'");
  }
  EXPECT_EQ(problem_of<double>(scalar("1", 1, true)), "expected a number, got '1'");
  EXPECT_EQ(problem_of<double>(Value()), "expected a number, got nothing");
  EXPECT_EQ(problem_of<double>(list({})), "expected a number, got a list of 0");
  EXPECT_EQ(problem_of<float>(scalar("1e39")), "expected a number, got 1e39");
}

TEST(ValueReaders, NumbersArePrintedToBeReadBack) {
  EXPECT_EQ(ValueReader<double>::print(1e6), "1000000");
  EXPECT_EQ(ValueReader<float>::print(16777216.0f), "16777216");
  EXPECT_EQ(ValueReader<double>::print(1e300), "1e+300");
  EXPECT_EQ(ValueReader<float>::print(0.1f), "0.1");
  EXPECT_EQ(ValueReader<double>::print(-2), "-2");
  for (const double number : {0.1, 1.0 / 3, 1e15, 123456789012345.0, -1e-7, 5e-324}) {
    EXPECT_EQ(parse_number(ValueReader<double>::print(number)), number);
  }
}

TEST(ValueReaders, Ranges) {
  const KeyOptions unit{.min = 0, .max = 1};
  EXPECT_EQ(read<float>(scalar("0"), unit), 0.0f);
  EXPECT_EQ(read<float>(scalar("1"), unit), 1.0f);
  EXPECT_EQ(problem_of<float>(scalar("1.5"), unit), "expected a number 0 .. 1, got 1.5");
  const KeyOptions positive{.min = 0, .above_min = true};
  EXPECT_EQ(problem_of<float>(scalar("0"), positive), "expected a number > 0, got 0");
  EXPECT_EQ(problem_of<int>(scalar("0"), positive), "expected a whole number > 0, got 0");
  EXPECT_EQ(range_text({}), "");
  EXPECT_EQ(range_text({.min = 2}), ">= 2");
  EXPECT_EQ(range_text({.max = 2}), "<= 2");
  EXPECT_EQ(range_text({.min = 0, .max = 1, .above_min = true}), "> 0, <= 1");
}

TEST(ValueReaders, WholeNumbers) {
  EXPECT_EQ(read<int64_t>(scalar("9223372036854775807")), INT64_MAX);
  EXPECT_EQ(read<int64_t>(scalar("-9223372036854775808")), INT64_MIN);
  EXPECT_EQ(read<int64_t>(scalar("1e6")), 1000000);
  EXPECT_EQ(read<int64_t>(scalar("400_000")), 400000);
  EXPECT_EQ(read<int>(scalar("-5.0")), -5);
  EXPECT_EQ(problem_of<int>(scalar("1.5")), "expected a whole number, got '1.5'");
  EXPECT_EQ(problem_of<int>(scalar("3000000000")), "expected a whole number, got 3000000000");
  EXPECT_EQ(problem_of<int64_t>(scalar("9223372036854775808")),
            "expected a whole number, got '9223372036854775808'");
  EXPECT_EQ(problem_of<int64_t>(scalar("1e300")), "expected a whole number, got '1e300'");
}

TEST(ValueReaders, BooleansAndText) {
  EXPECT_TRUE(read<bool>(scalar("true")));
  EXPECT_FALSE(read<bool>(scalar("false")));
  EXPECT_EQ(problem_of<bool>(scalar("yes")), "expected true or false, got 'yes'");
  EXPECT_EQ(problem_of<bool>(scalar("true", 1, true)), "expected true or false, got 'true'");
  EXPECT_EQ(read<std::string>(scalar("007")), "007");
  EXPECT_EQ(problem_of<std::string>(list({})), "expected text, got a list of 0");
  EXPECT_EQ(read<NameReference>(scalar("rat", 4)).position.line, 4);
  EXPECT_EQ(problem_of<NameReference>(scalar("", 1, true)), "expected a name, got ''");
}

TEST(ValueReaders, Paths) {
  const auto path_in = [](SourcePosition where, const char* text) {
    return read<AssetPath>(Value::scalar(where, text)).path.string();
  };
  EXPECT_EQ(path_in({"scenes/a.yaml", 1, 1}, "rat.obj"), "scenes/rat.obj");
  EXPECT_EQ(path_in({"scenes/a.yaml", 1, 1}, "../rat.obj"), "rat.obj");
  EXPECT_EQ(path_in({"a.yaml", 1, 1}, "poses/walk.%04d.obj"), "poses/walk.%04d.obj");
  EXPECT_EQ(path_in({"scenes/a.yaml", 1, 1}, "/abs/rat.obj"), "/abs/rat.obj");
  EXPECT_EQ(path_in({"--set skins/x.mesh", 0, 0}, "rat.obj"), "rat.obj");
  EXPECT_EQ(problem_of<AssetPath>(scalar("", 1, true)), "expected a file name, got ''");
  EXPECT_EQ(problem_of<AssetPath>(scalar(std::string("a\0b", 3))), "expected a file name, got 'a?b'");
}

TEST(ValueReaders, Bytes) {
  EXPECT_EQ(read<ByteSize>(scalar("4G")).bytes, uint64_t(4) << 30);
  EXPECT_EQ(read<ByteSize>(scalar("1.5G")).bytes, uint64_t(3) << 29);
  EXPECT_EQ(read<ByteSize>(scalar("512MiB")).bytes, uint64_t(512) << 20);
  EXPECT_EQ(read<ByteSize>(scalar("16KB")).bytes, uint64_t(16) << 10);
  EXPECT_EQ(read<ByteSize>(scalar("123")).bytes, 123u);
  for (const char* text : {"", "G", "4X", "-1G", "9e30", "4 G", "B"}) EXPECT_FALSE(parse_bytes(text)) << text;
  EXPECT_EQ(problem_of<ByteSize>(scalar("much")), "expected bytes such as 512M or 4G, got 'much'");
  EXPECT_EQ(ValueReader<ByteSize>::print({uint64_t(4) << 30}), "4G");
  EXPECT_EQ(ValueReader<ByteSize>::print({uint64_t(3) << 29}), "1536M");
  EXPECT_EQ(ValueReader<ByteSize>::print({1000}), "1000");
}

TEST(ValueReaders, VectorsAndColours) {
  EXPECT_EQ(read<V3f>(numbers({"1", "2", "3"})), V3f(1, 2, 3));
  EXPECT_EQ(read<V2f>(numbers({"1", "2"})), V2f(1, 2));
  EXPECT_EQ(problem_of<V3f>(numbers({"1", "2"})), "expected a list of 3 numbers, got a list of 2");
  EXPECT_EQ(problem_of<V3f>(scalar("1")), "expected a list of 3 numbers, got '1'");
  EXPECT_EQ(problem_of<V3f>(numbers({"1", "x", "3"})), "expected a number, got 'x'");
  EXPECT_EQ(read<Rgb>(scalar("0.5")), Rgb(0.5f));
  EXPECT_EQ(read<Rgb>(numbers({"0", "0.5", "1"})), Rgb(0, 0.5f, 1));
  EXPECT_EQ(problem_of<Rgb>(scalar("red")), "expected a colour, [r, g, b] or one number, got 'red'");
  EXPECT_EQ(problem_of<Rgb>(scalar("-1"), {.min = 0}), "expected a number >= 0, got -1");
  EXPECT_EQ(ValueReader<V3f>::print(V3f(1, 0.1f, -2)), "[1, 0.1, -2]");
}

TEST(ValueReaders, Enumerations) {
  EXPECT_EQ(read<Shape>(scalar("round-box")), Shape::kRoundBox);
  EXPECT_EQ(problem_of<Shape>(scalar("round_box")),
            "expected box | round-box, got 'round_box'; did you mean 'round-box'?");
  EXPECT_EQ(problem_of<Shape>(scalar("sphere")), "expected box | round-box, got 'sphere'");
  EXPECT_EQ(problem_of<Shape>(scalar("sphere"), {.removed = {"sphere", "use a round box"}}),
            "'sphere' was removed: use a round box");
  EXPECT_EQ(ValueReader<Shape>::print(Shape::kRoundBox), "round-box");
}

TEST(ValueReaders, ListsNamesAndOptionals) {
  EXPECT_EQ(read<std::vector<int>>(numbers({"1", "2"})), (std::vector<int>{1, 2}));
  EXPECT_EQ(problem_of<std::vector<int>>(scalar("1")), "expected list of integer, got '1'");
  const auto named = read<Named<int>>(block({{"b", scalar("1")}, {"a", scalar("2")}}));
  EXPECT_EQ(named.names(), (std::vector<std::string>{"b", "a"}));
  EXPECT_EQ(named.find("a")->value, 2);
  EXPECT_EQ(named.find("a")->position.line, 2);
  EXPECT_EQ(named.find("c"), nullptr);
  std::optional<int> lens = 3;
  Problems problems;
  EXPECT_TRUE(ValueReader<std::optional<int>>::read(Value(), {}, lens, problems));
  EXPECT_FALSE(lens);
}

TEST(ValueReaders, EveryProblemOfAListIsReported) {
  std::vector<int> out;
  Problems problems;
  EXPECT_FALSE(ValueReader<std::vector<int>>::read(numbers({"x", "1", "y"}), {}, out, problems));
  EXPECT_EQ(problems.list().size(), 2u);
}

}  // namespace
}  // namespace pelage::value_readers_test
