// SPDX-License-Identifier: Apache-2.0
#include "base/schema.h"

#include <optional>

#include <gtest/gtest.h>

#include "base/value_readers.h"
#include "tests/support/parsed_value.h"

namespace pelage {
namespace {

struct LensTable {
  float f_stop = 8;
  static const Schema<LensTable>& schema() {
    static const Schema<LensTable> table = [] {
      Schema<LensTable> s("lens", "Blurs.");
      s.key("f_stop", &LensTable::f_stop, {.help = "Stops", .min = 0, .above_min = true});
      return s;
    }();
    return table;
  }
};

struct CurlTable {
  float radius = 0.05f;
  int turns = 2;
  std::string name;
  std::optional<LensTable> lens;
  static const Schema<CurlTable>& schema() {
    static const Schema<CurlTable> table = [] {
      Schema<CurlTable> s("curl", "Winds.");
      s.key("radius", &CurlTable::radius, {.unit = "units", .help = "Of the helix", .min = 0});
      s.key("turns", &CurlTable::turns, {.help = "Turns", .required = true});
      s.key("name", &CurlTable::name, {.default_text = "that of the operator"});
      s.key("lens", &CurlTable::lens, {});
      return s;
    }();
    return table;
  }
};

struct Sphere {
  static constexpr const char* kTypeKey = "type";
  static constexpr const char* kTypeName = "sphere";
  float radius = 1;
  static const Schema<Sphere>& schema() {
    static const Schema<Sphere> table = [] {
      Schema<Sphere> s("sphere", "");
      s.key("radius", &Sphere::radius, {});
      return s;
    }();
    return table;
  }
};
struct Sky {
  static constexpr const char* kTypeKey = "type";
  static constexpr const char* kTypeName = "environment";
  static const Schema<Sky>& schema() {
    static const Schema<Sky> table("environment", "");
    return table;
  }
};
using Light = std::variant<Sphere, Sky>;

std::vector<std::string> lines_of(const Problems& problems) {
  std::vector<std::string> lines;
  for (const Problem& problem : problems.list()) {
    lines.push_back(to_string(problem.position) + ": " + problem.message);
  }
  return lines;
}
using Lines = std::vector<std::string>;

TEST(Schema, FillsTheStruct) {
  CurlTable curl;
  Problems problems;
  const Value value = block({{"turns", scalar("3")}, {"lens", block({{"f_stop", scalar("4")}})}});
  EXPECT_TRUE(CurlTable::schema().read(value, curl, problems));
  EXPECT_EQ(curl.turns, 3);
  EXPECT_EQ(curl.radius, 0.05f);
  ASSERT_TRUE(curl.lens);
  EXPECT_EQ(curl.lens->f_stop, 4.0f);
}

TEST(Schema, ReportsEveryMistakeAtItsPlace) {
  CurlTable curl;
  Problems problems;
  const Value value = block({{"raduis", scalar("3")},
                             {"radius", scalar("-1", 2)},
                             {"zebra", scalar("1")},
                             {"lens", block({{"f_stop", scalar("0", 4)}})}});
  EXPECT_FALSE(CurlTable::schema().read(value, curl, problems));
  EXPECT_EQ(lines_of(problems),
            (Lines{
                "t:1:1: unknown key 'raduis' in curl; did you mean 'radius'?",
                "t:2:1: expected a number >= 0, got -1",
                "t:3:1: unknown key 'zebra' in curl; expected one of radius, turns, name, lens",
                "t:4:1: expected a number > 0, got 0",
                "t:1:1: curl needs the key 'turns'",
            }));
}

TEST(Schema, TellsWhichKeysWereRemoved) {
  Schema<Sphere> table("sphere", "");
  table.remove({"round", "every sphere is", "true"});
  table.remove({"facets", "give only a radius"});
  const auto lines = [&](const char* key, const Value& value) {
    Sphere sphere;
    Problems problems;
    table.read(block({{key, value}}), sphere, problems);
    return lines_of(problems);
  };
  EXPECT_EQ(lines("round", scalar("true")), Lines{});
  EXPECT_EQ(lines("round", scalar("false")), Lines{"t:1:1: 'round' was removed: every sphere is"});
  EXPECT_EQ(lines("round", block({})), Lines{"t:1:1: 'round' was removed: every sphere is"});
  EXPECT_EQ(lines("facets", scalar("")), Lines{"t:1:1: 'facets' was removed: give only a radius"});
}

TEST(Schema, WantsABlock) {
  CurlTable curl;
  Problems problems;
  EXPECT_FALSE(CurlTable::schema().read(scalar("5", 7), curl, problems));
  EXPECT_EQ(lines_of(problems), Lines{"t:7:1: expected a block of keys (curl), got '5'"});
}

TEST(Schema, SkipsOnlyTheKeyItIsTold) {
  Sphere sphere;
  Problems problems;
  EXPECT_TRUE(Sphere::schema().read(block({{"type", scalar("sphere")}}), sphere, problems, "type"));
  EXPECT_FALSE(Sphere::schema().read(block({{"", scalar("sphere")}}), sphere, problems));
}

TEST(Schema, BlocksOfSeveralKinds) {
  const auto lines = [](const Value& value) {
    Light light;
    Problems problems;
    const bool good = ValueReader<Light>::read(value, {}, light, problems);
    EXPECT_EQ(good, problems.empty());
    return lines_of(problems);
  };
  EXPECT_EQ(lines(block({{"radius", scalar("2")}, {"type", scalar("sphere")}})), Lines{});
  EXPECT_EQ(lines(block({{"type", scalar("shpere")}})),
            Lines{"t:1:1: expected sphere | environment, got 'shpere'; did you mean 'sphere'?"});
  EXPECT_EQ(lines(block({{"radius", scalar("1")}})),
            Lines{"t:1:1: the block needs the key 'type': sphere | environment"});
  EXPECT_EQ(lines(scalar("sphere")),
            Lines{"t:1:1: expected a block with 'type: sphere | environment', got 'sphere'"});
  EXPECT_EQ(lines(block({{"type", scalar("environment")}, {"radius", scalar("1")}})),
            Lines{"t:2:1: unknown key 'radius' in environment; expected type"});
}

TEST(Schema, ListsItsKeysForTheManual) {
  const std::vector<KeyInfo>& keys = CurlTable::schema().keys();
  ASSERT_EQ(keys.size(), 4u);
  EXPECT_EQ(keys[0].name, "radius");
  EXPECT_EQ(keys[0].type, "number");
  EXPECT_EQ(keys[0].default_text, "0.05");
  EXPECT_EQ(keys[1].default_text, "");  // required
  EXPECT_EQ(keys[2].default_text, "that of the operator");
  EXPECT_EQ(keys[3].default_text, "none");
  ASSERT_EQ(keys[3].blocks.size(), 1u);
  EXPECT_EQ(keys[3].blocks[0], &LensTable::schema());
  EXPECT_EQ(ValueReader<Light>::blocks().size(), 2u);
  EXPECT_EQ(ValueReader<Light>::type_name(), "block with type: sphere | environment");
}

}  // namespace
}  // namespace pelage
