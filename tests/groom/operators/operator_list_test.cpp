// SPDX-License-Identifier: Apache-2.0
#include "groom/operators/operator_list.h"

#include <gtest/gtest.h>

#include "groom/coat/groom_params.h"
#include "tests/groom/scene_text.h"

namespace pelage {
namespace {

std::string message_of(const std::string& yaml) {
  Problems problems;
  scene_text::read<OperatorList>(yaml, problems);
  EXPECT_FALSE(problems.empty());
  if (problems.empty()) return "";
  return to_string(problems.list().front().position) + ": " + problems.list().front().message;
}

TEST(OperatorList, ReadsOperatorsInOrder) {
  const auto list = scene_text::read<OperatorList>(
      "- length: {value: 1.2, variation: 0.3}\n"
      "- comb: {direction: [0, -0.3, -1], lift: 0.35}\n"
      "- clump: {spacing: 0.4, amount: 0.6, levels: [{spacing: 0.1, amount: 0.8}]}\n"
      "- curl: {radius: 0.05, turns: 2}\n"
      "- frizz: {amplitude: 0.02, frequency: 3}\n"
      "- noise:\n"
      "- push_out: {offset: 0.01}\n"
      "- width: {root: 0.008, tip: 0.001}\n"
      "- color: {value: {ramp: {along: strand, knots: [[0, [0.1, 0.08, 0.06]], [1, [0.5, 0.3, 0.15]]]}}}\n");
  ASSERT_EQ(list.items.size(), 9u);
  EXPECT_EQ(list.items[2].name, "clump");
  EXPECT_EQ(list.items[2].prototype->traits().name, "clump");
  EXPECT_EQ(list.items[2].position.line, 4);
  EXPECT_FALSE(list.items[6].prototype->traits().reads_rest_only);
  const auto copy = list.items[4].clone(*list.items[4].prototype);
  EXPECT_EQ(copy->traits().name, "frizz");
}

TEST(OperatorList, NamesTheNearestOperatorAndKey) {
  EXPECT_EQ(message_of("- clmup: {spacing: 1}\n"),
            "scene.yaml:2:5: unknown operator 'clmup'; did you mean 'clump'?");
  EXPECT_NE(message_of("- width: {root: 1, tpi: 2}\n").find("'tip'"), std::string::npos);
  EXPECT_NE(message_of("length: {value: 1}\n").find("expected a list of operators"), std::string::npos);
  EXPECT_NE(message_of("- {length: {value: 1}, comb: {}}\n").find("expected one operator"),
            std::string::npos);
  EXPECT_NE(message_of("- clump: {spacing: 0}\n").find("scene.yaml:2:"), std::string::npos);
  EXPECT_NE(message_of("- length: {value: -1}\n").find("scene.yaml:2:"), std::string::npos);
  EXPECT_NE(message_of("- guides: {}\n").find("file"), std::string::npos);
  EXPECT_EQ(message_of("- length: {value: 1, maks: 0.5}\n"),
            "scene.yaml:2:24: unknown key 'maks' in length; did you mean 'mask'?");
  EXPECT_EQ(message_of("- length: {value: 1, amuont: 0.5}\n"),
            "scene.yaml:2:24: unknown key 'amuont' in length; did you mean 'amount'?");
  EXPECT_NE(message_of("- length: {value: 1, amount: 2}\n").find("scene.yaml:2:32: "), std::string::npos);
  EXPECT_NE(message_of("- length: {value: 1, mask: 2}\n").find("scene.yaml:2:30: "), std::string::npos);
}

TEST(OperatorList, EveryOperatorIsInTheManual) {
  const std::vector<const SchemaInfo*> blocks = ValueReader<OperatorList>::blocks();
  EXPECT_EQ(blocks.size(), 18u);  // the operators, and the keys `mask` and `amount` of each
  for (const SchemaInfo* block : blocks) {
    EXPECT_FALSE(block->help().empty());
    for (const KeyInfo& key : block->keys())
      EXPECT_FALSE(key.options.help.empty()) << block->name() << "." << key.name;
  }
}

TEST(GroomParams, RefusesNumbersThatMakeNoSense) {
  for (const char* bad : {"strands: -4", "strands: 0", "density: -1", "points: 1", "leaf_strands: 0",
                          "role: wool", "default_width: 0", "strands: 1.5"}) {
    Problems problems;
    scene_text::read<GroomParams>("skin: rat\n" + std::string(bad) + "\n", problems);
    ASSERT_EQ(problems.list().size(), 1u) << bad;
    EXPECT_EQ(problems.list().front().position.line, 3) << bad;
  }
}

}  // namespace
}  // namespace pelage
