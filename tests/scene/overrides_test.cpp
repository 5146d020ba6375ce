// SPDX-License-Identifier: Apache-2.0
#include "scene/overrides.h"

#include <gtest/gtest.h>

#include "tests/scene/document_text.h"

namespace pelage {
namespace {

constexpr const char* kScene =
    "render: {samples: 64}\n"
    "lens:\n"
    "operators:\n"
    "  - length: {value: 1}\n"
    "  - clump: {name: coarse, amount: 1}\n"
    "  - clump: {name: fine, amount: 2}\n"
    "  - 5\n";

struct Outcome {
  std::string document;
  Lines problems;
};

Outcome with(const std::vector<std::string>& texts) {
  Value document = parse_document(kScene, "s");
  Problems problems;
  DocumentLimits limits;
  for (const std::string& text : texts) apply_override(parse_override(text), document, limits, problems);
  Outcome outcome{flat(document), {}};
  for (const Problem& problem : problems.list()) {
    outcome.problems.push_back(to_string(problem.position) + ": " + problem.message);
  }
  return outcome;
}

std::string with_one(const std::string& text, const std::string& key) {
  Value document = parse_document(kScene, "s");
  Problems problems;
  DocumentLimits limits;
  apply_override(parse_override(text), document, limits, problems);
  EXPECT_TRUE(problems.empty());
  const Value* value = document.find(key);
  return value ? flat(*value) : "";
}

TEST(Overrides, AreSplitAtTheFirstEqualsSign) {
  EXPECT_EQ(parse_override("a.b=c=d").key, "a.b");
  EXPECT_EQ(parse_override("a.b=c=d").value, "c=d");
  EXPECT_EQ(parse_override("a=").value, "");
  EXPECT_EQ(error_lines([] { parse_override("a.b"); }),
            Lines{"--set a.b: expected a key and a value, a.b.c=value"});
  EXPECT_EQ(error_lines([] { parse_override("=3"); }),
            Lines{"--set =3: expected a key and a value, a.b.c=value"});
}

TEST(Overrides, ReplaceAndAdd) {
  EXPECT_EQ(with_one("render.samples=7", "render"), "{samples: 7}");
  EXPECT_EQ(with_one("render.bounces=2", "render"), "{samples: 64, bounces: 2}");
  EXPECT_EQ(with_one("render={x: [1, 2]}", "render"), "{x: [1, 2]}");
  EXPECT_EQ(with_one("a.b.c=1", "a"), "{b: {c: 1}}");
  EXPECT_EQ(with_one("rendr={a: 1}", "rendr"), "{a: 1}");
  EXPECT_EQ(with_one("rendr=5", "rendr"), "5");
  EXPECT_EQ(with_one("lens.f_stop=4", "lens"), "{f_stop: 4}");
  EXPECT_EQ(with_one("render=", "render"), "null");
  EXPECT_EQ(with_one("render='5'", "render"), "\"5\"");
}

TEST(Overrides, ReachItemsOfLists) {
  const std::string rest = ", {clump: {name: coarse, amount: 1}}, {clump: {name: fine, amount: 2}}, 5]";
  EXPECT_EQ(with_one("operators.length.value=3", "operators"), "[{length: {value: 3}}" + rest);
  EXPECT_EQ(with_one("operators.0.length.value=3", "operators"), "[{length: {value: 3}}" + rest);
  EXPECT_EQ(with_one("operators.0=3", "operators"), "[3" + rest);
  EXPECT_EQ(
      with_one("operators.fine.amount=9", "operators"),
      "[{length: {value: 1}}, {clump: {name: coarse, amount: 1}}, {clump: {name: fine, amount: 9}}, 5]");
}

TEST(Overrides, NullRemoves) {
  EXPECT_EQ(with_one("render.samples=null", "render"), "{}");
  EXPECT_EQ(with_one("render=null", "render"), "");
  EXPECT_EQ(with_one("render=~", "render"), "");
  EXPECT_EQ(with_one("operators.fine=null", "operators"),
            "[{length: {value: 1}}, {clump: {name: coarse, amount: 1}}, 5]");
  EXPECT_EQ(with_one("operators.3=null", "operators"),
            "[{length: {value: 1}}, {clump: {name: coarse, amount: 1}}, {clump: {name: fine, amount: 2}}]");
  EXPECT_EQ(with_one("operators.0.length.value=null", "operators").substr(0, 14), "[{length: {}},");
  // The schema knows whether a missing key may have no value.
  EXPECT_EQ(with_one("render.lens=null", "render"), "{samples: 64, lens: null}");
  EXPECT_EQ(with({"render.sampels=null"}).problems,
            Lines{"--set render.sampels: no 'sampels' to remove; did you mean 'samples'?"});
  EXPECT_EQ(with({"operators.7=null"}).problems,
            Lines{"--set operators.7: no item 7 in a list of 4 (the first is 0)"});
}

TEST(Overrides, LaterOnesWin) {
  EXPECT_EQ(with({"lens=1", "lens=2"}).document.find("lens: 1"), std::string::npos);
}

TEST(Overrides, MistakesNameTheFlag) {
  EXPECT_EQ(with({"operators.clmup.amount=1"}).problems,
            Lines{"--set operators.clmup.amount: no item 'clmup' in the list; did you mean 'clump'?"});
  EXPECT_EQ(with({"operators.clump.amount=1"}).problems,
            Lines{"--set operators.clump.amount: 'clump' is the name of several items of the list; use an "
                  "index: 1 2"});
  EXPECT_EQ(with({"operators.4=1"}).problems,
            Lines{"--set operators.4: no item 4 in a list of 4 (the first is 0)"});
  EXPECT_EQ(with({"render.samples.x=1"}).problems,
            Lines{"--set render.samples.x: cannot look up 'x' in '64', which is not a block"});
  EXPECT_EQ(with({"rendr.samples=1"}).problems,
            Lines{"--set rendr.samples: no block 'rendr'; did you mean 'render'? (to add a new block, "
                  "give it whole, as rendr={...})"});
  EXPECT_EQ(with({"render..x=1", ".=1"}).problems,
            (Lines{"--set render..x: expected names separated by single dots",
                   "--set .: expected names separated by single dots"}));
  EXPECT_EQ(with({"a=[1"}).problems, Lines{"--set a: malformed YAML: expected ',' or ']'"});
  EXPECT_EQ(with({"a=*b"}).problems,
            Lines{"--set a: aliases are not supported; share values with 'include:'"});
  EXPECT_EQ(with({"a={b: 1, b: 2}"}).problems, Lines{"--set a: duplicate key 'b'"});
}

TEST(Overrides, PositionsSayTheFlag) {
  Value document = parse_document(kScene, "s");
  Problems problems;
  DocumentLimits limits;
  apply_override(parse_override("a.b={c: [1]}"), document, limits, problems);
  const Value& b = *document.find("a")->find("b");
  EXPECT_EQ(to_string(b.position()), "--set a.b");
  EXPECT_EQ(to_string(b.find("c")->items()[0].position()), "--set a.b");
  EXPECT_EQ(to_string(b.entries()[0].key_position), "--set a.b");
}

}  // namespace
}  // namespace pelage
