// SPDX-License-Identifier: Apache-2.0
#include "image/field.h"

#include <cmath>
#include <limits>
#include <string>

#include <gtest/gtest.h>

#include "base/hash.h"

namespace pelage {
namespace {

// Values as a scene file would give them, at line 1 and the columns of their text.
Value scalar(const std::string& text, int column = 1) { return Value::scalar({"s.yaml", 1, column}, text); }
Value list(std::vector<Value> items, int column = 1) {
  return Value::list({"s.yaml", 1, column}, std::move(items));
}
Value numbers(std::initializer_list<const char*> texts, int column = 1) {
  std::vector<Value> items;
  for (const char* text : texts) items.push_back(scalar(text, column));
  return list(std::move(items), column);
}
Value::Entry entry(const std::string& key, Value value) { return {key, {"s.yaml", 1, 3}, std::move(value)}; }
Value map(std::vector<Value::Entry> entries) { return Value::map({"s.yaml", 1, 2}, std::move(entries)); }

Value ramp(const char* along, std::vector<Value> knots) {
  return map(
      {entry("ramp", map({entry("along", scalar(along)), entry("knots", list(std::move(knots), 20))}))});
}

Field read(const Value& value, const KeyOptions& options = {}) {
  Field field;
  Problems problems;
  EXPECT_TRUE(ValueReader<Field>::read(value, options, field, problems));
  for (const Problem& problem : problems.list()) ADD_FAILURE() << problem.message;
  return field;
}

std::string error_of(const Value& value, const KeyOptions& options = {}) {
  Field field(-7.0f);
  Problems problems;
  EXPECT_FALSE(ValueReader<Field>::read(value, options, field, problems));
  EXPECT_EQ(field.value({}), -7.0f) << "out was touched";
  std::string all;
  for (const Problem& problem : problems.list()) {
    all += (all.empty() ? "" : "\n") + to_string(problem.position) + ": " + problem.message;
  }
  return all;
}

FieldPoint along(float v) {
  FieldPoint point;
  point.along = v;
  return point;
}

TEST(Field, IsAConstant) {
  EXPECT_EQ(Field().value({}), 0);
  EXPECT_EQ(read(scalar("0.5")).value({}), 0.5f);
  EXPECT_EQ(read(scalar("0.5")).color({}), Rgb(0.5f));
  const Field color = read(numbers({"1", "2", "3"}));
  EXPECT_EQ(color.color({}), Rgb(1, 2, 3));
  EXPECT_EQ(color.value({}), 1);
  EXPECT_TRUE(color.is_constant());
  EXPECT_EQ(color.value_range(), std::pair(1.0f, 1.0f));
  EXPECT_EQ(ValueReader<Field>::print(color), "[1, 2, 3]");
  EXPECT_EQ(ValueReader<Field>::print(Field(0.05f)), "0.05");
}

TEST(Field, RampsAlongAStrand) {
  const Field field =
      read(ramp("strand", {numbers({"0.25", "1"}), numbers({"0.5", "3"}), numbers({"1", "2"})}));
  EXPECT_EQ(field.value(along(0)), 1);
  EXPECT_EQ(field.value(along(0.25f)), 1);
  EXPECT_EQ(field.value(along(0.375f)), 2);
  EXPECT_EQ(field.value(along(0.5f)), 3);
  EXPECT_EQ(field.value(along(0.75f)), 2.5f);
  EXPECT_EQ(field.value(along(1)), 2);
  EXPECT_EQ(field.value(along(7)), 2);
  EXPECT_EQ(field.value_range(), std::pair(1.0f, 3.0f));
  EXPECT_TRUE(field.dependence().along);
  EXPECT_FALSE(field.dependence().surface);
  EXPECT_FALSE(field.is_constant());
}

TEST(Field, RampsOverTheSkin) {
  FieldPoint point;
  point.rest = V3f(1, 2, 3);
  point.u = 4;
  point.v = 5;
  const char* axes[] = {"x", "y", "z", "u", "v"};
  for (int i = 0; i < 5; ++i) {
    const Field field = read(ramp(axes[i], {numbers({"0", "0"}), numbers({"10", "100"})}));
    EXPECT_FLOAT_EQ(field.value(point), 10 * static_cast<float>(i + 1));
    EXPECT_TRUE(field.dependence().surface);
    EXPECT_FALSE(field.dependence().along);
  }
}

TEST(Field, RampsColoursAndSteps) {
  const Field field = read(
      ramp("strand",
           {list({scalar("0"), numbers({"1", "0", "0"})}), list({scalar("0.5"), numbers({"0", "1", "0"})}),
            list({scalar("0.5"), numbers({"0", "0", "1"})}), list({scalar("1"), scalar("0.5")})}));
  EXPECT_EQ(field.color(along(0.25f)), Rgb(0.5f, 0.5f, 0));
  EXPECT_EQ(field.color(along(0.5f)), Rgb(0, 0, 1)) << "a step takes the upper value";
  EXPECT_EQ(field.color(along(1)), Rgb(0.5f));
}

TEST(Field, AddsNoise) {
  const Field field =
      read(map({entry("noise", map({entry("frequency", scalar("2")), entry("amplitude", scalar("-0.25")),
                                    entry("offset", scalar("1"))}))}));
  FieldPoint point;
  point.rest = V3f(0.3f, 0.7f, 1.9f);
  EXPECT_EQ(field.value(point), 1.0f - 0.25f * perlin_noise(2.0f * point.rest));
  EXPECT_EQ(field.value_range(), std::pair(0.75f, 1.25f));
  EXPECT_TRUE(field.dependence().surface);
}

TEST(Field, ReadsAttributesAndMultiplies) {
  const Field field = read(map({entry("product", list({scalar("2"), map({entry("attribute", scalar("tint"))}),
                                                       map({entry("attribute", scalar("age"))}),
                                                       map({entry("attribute", scalar("tint"))})}))}));
  const FieldAttribute attributes[] = {{"age", Rgb(3)}, {"tint", Rgb(1, 0.5f, 2)}};
  FieldPoint point;
  point.attributes = attributes;
  EXPECT_EQ(field.color(point), Rgb(6, 1.5f, 24));
  EXPECT_EQ(field.value(point), 6);
  EXPECT_EQ(field.attribute_names(), (std::vector<std::string>{"tint", "age"}));
  EXPECT_TRUE(field.dependence().attributes);
  EXPECT_EQ(field.value_range().second, std::numeric_limits<float>::infinity());
  EXPECT_EQ(ValueReader<Field>::print(field),
            "{product: [2, {attribute: tint}, {attribute: age}, {attribute: tint}]}");
}

TEST(Field, RangeOfAProductHasTheRightSigns) {
  const auto ends = [](const char* a, const char* b) {
    return ramp("strand", {numbers({"0", a}), numbers({"1", b})});
  };
  const Field field = read(map({entry("product", list({ends("-1", "2"), ends("-5", "3")}))}));
  EXPECT_EQ(field.value_range(), std::pair(-10.0f, 6.0f));
  const Field zero =
      read(map({entry("product", list({scalar("0"), map({entry("attribute", scalar("a"))})}))}));
  EXPECT_EQ(zero.value_range(), std::pair(0.0f, 0.0f));
}

TEST(Field, ValuesStayWithinTheirRange) {
  const Field field = read(map({entry(
      "product", list({ramp("strand", {numbers({"0", "-1"}), numbers({"0.3", "2"}), numbers({"1", "0.5"})}),
                       map({entry("noise", map({entry("offset", scalar("0.2"))}))})}))}));
  const auto [low, high] = field.value_range();
  for (uint64_t i = 0; i < 5000; ++i) {
    FieldPoint point;
    point.along = unit_float(hash64(i, 1));
    point.rest = 10.0f * V3f(unit_float(hash64(i, 2)), unit_float(hash64(i, 3)), unit_float(hash64(i, 4)));
    EXPECT_GE(field.value(point), low);
    EXPECT_LE(field.value(point), high);
  }
}

TEST(Field, LimitsHoldForEveryValue) {
  KeyOptions positive;
  positive.min = 0;
  positive.max = 1;
  const Field field = read(map({entry("attribute", scalar("a"))}), positive);
  const FieldAttribute attributes[] = {{"a", Rgb(-1, 0.5f, 7)}};
  FieldPoint point;
  point.attributes = attributes;
  EXPECT_EQ(field.color(point), Rgb(0, 0.5f, 1));
  EXPECT_EQ(field.value(point), 0);
  EXPECT_EQ(field.value_range(), std::pair(0.0f, 1.0f));
  EXPECT_EQ(field.attribute_names(), std::vector<std::string>{"a"});
  EXPECT_EQ(ValueReader<Field>::print(field), "{attribute: a}");
  positive.above_min = true;
  EXPECT_GT(read(map({entry("attribute", scalar("a"))}), positive).value(point), 0);
  // A factor alone may be outside.
  const Field product = read(map({entry("product", list({scalar("3"), scalar("0.25")}))}), positive);
  EXPECT_EQ(product.value({}), 0.75f);
}

TEST(Field, RefusesStatedNumbersOutsideTheLimits) {
  KeyOptions limits;
  limits.min = 0;
  limits.max = 2;
  EXPECT_EQ(error_of(scalar("-1", 4), limits), "s.yaml:1:4: expected a number 0 .. 2, got -1");
  EXPECT_EQ(error_of(ramp("strand", {numbers({"0", "1"}, 21), numbers({"1", "5"}, 29)}), limits),
            "s.yaml:1:29: expected a number 0 .. 2, got 5");
  EXPECT_EQ(error_of(map({entry("noise", map({entry("offset", scalar("-3", 9))}))}), limits),
            "s.yaml:1:9: expected a number 0 .. 2, got -3");
  EXPECT_EQ(error_of(map({entry("map", scalar("a.png")), entry("range", numbers({"0", "3"}, 8))}), limits),
            "s.yaml:1:8: expected a number 0 .. 2, got 3");
}

TEST(Field, NamesWhatWasExpected) {
  EXPECT_EQ(
      error_of(scalar("red", 4)),
      "s.yaml:1:4: expected a number, a colour [r, g, b], or a block with a kind of field, such as map, ramp "
      "or noise, got 'red'");
  EXPECT_EQ(
      error_of(numbers({"1", "2"}, 4)),
      "s.yaml:1:4: expected a number, a colour [r, g, b], or a block with a kind of field, such as map, ramp "
      "or noise, got a list of 2");
  EXPECT_EQ(error_of(map({entry("rammp", scalar("1"))})),
            "s.yaml:1:3: unknown kind of field 'rammp'; did you mean 'ramp'?");
  EXPECT_EQ(error_of(map({})),
            "s.yaml:1:2: expected a kind of field, such as map, ramp or noise, got an empty block");
  EXPECT_EQ(error_of(map({entry("map", scalar("f.png")), entry("chanel", scalar("r"))})),
            "s.yaml:1:3: unknown key 'chanel' in map field; did you mean 'channel'?");
  EXPECT_EQ(error_of(map({entry("map", scalar("f.png")), entry("channel", scalar("x", 7))})),
            "s.yaml:1:7: expected r | g | b | a, got 'x'; did you mean 'r'?");
  EXPECT_EQ(error_of(map({entry("noise", map({entry("ampiltude", scalar("1"))}))})),
            "s.yaml:1:3: unknown key 'ampiltude' in noise of a field; did you mean 'amplitude'?");
  EXPECT_EQ(error_of(map({entry("product", list({}, 5))})), "s.yaml:1:5: a product needs at least 1 factor");
  EXPECT_EQ(error_of(map({entry("attribute", scalar("", 6))})),
            "s.yaml:1:6: expected the name of an attribute, got ''");
  EXPECT_NE(error_of(map({entry("ramp", map({})), entry("noise", map({}))})).find("unknown key 'noise'"),
            std::string::npos);
}

TEST(Field, ChecksKnots) {
  EXPECT_EQ(error_of(ramp("strand", {numbers({"0.5", "1"}, 21), numbers({"0.25", "5"}, 29)})),
            "s.yaml:1:29: knots must be in rising order, got 0.25 after 0.5");
  EXPECT_EQ(error_of(ramp("strand", {numbers({"0.5", "1"})})),
            "s.yaml:1:20: a ramp needs at least 2 knots, got 1");
  EXPECT_EQ(error_of(ramp("strand", {numbers({"0.5", "1", "2"}, 21), numbers({"1", "1"})})),
            "s.yaml:1:21: expected a knot, [position, value], got a list of 3");
  EXPECT_EQ(error_of(ramp("tip", {numbers({"0", "1"}), numbers({"1", "1"})})).substr(0, 60),
            "s.yaml:1:1: expected strand | x | y | z | u | v, got 'tip'");
}

TEST(Field, ManualListsItsBlocks) {
  std::vector<std::string> names;
  for (const SchemaInfo* block : ValueReader<Field>::blocks()) names.push_back(block->name());
  EXPECT_EQ(names,
            (std::vector<std::string>{
                "map field",    "ramp field",      "noise field",  "attribute field", "product field",
                "add field",    "min field",       "max field",    "mix field",       "invert field",
                "clamp field",  "threshold field", "step field",   "remap field",     "box field",
                "sphere field", "distance field",  "height field", "slope field",     "vertex_color field",
                "group field",  "curvature field", "region field"}));
}

}  // namespace
}  // namespace pelage
