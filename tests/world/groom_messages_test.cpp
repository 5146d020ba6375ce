// SPDX-License-Identifier: Apache-2.0
// What loading says of grooms has its place in the scene.
#include <string>
#include <vector>

#include <gtest/gtest.h>

#include "base/error.h"
#include "tests/support/quiet_job.h"
#include "tests/world/small_scene.h"
#include "world/compose.h"

namespace pelage {
namespace {

struct KeptWarnings final : Progress {
  void begin(std::string_view, double) override {}
  void advance(double) override {}
  void end() override {}
  void warn(std::string_view message) override { list.emplace_back(message); }
  bool cancelled() const override { return false; }
  std::vector<std::string> list;
};

class GroomMessagesTest : public testing::Test {
 protected:
  void load(const std::string& groom) {
    files_.write("scene.yaml", "pelage: 1\nskins: {cube: {mesh: cube.obj}}\ngrooms:\n  coat: {" + groom +
                                   "}\nmaterials: {hide: {model: lambert}}\n"
                                   "characters: {a: {parts: [{skin: cube, material: hide}]}}\n");
    MemoryLedger ledger;
    load_assets(load_scene(files_.path("scene.yaml"), {}), Job{workers_, ledger, warnings_});
  }

  SmallScene files_;
  Workers workers_{2};
  KeptWarnings warnings_;
};

TEST_F(GroomMessagesTest, ADensityOfTooManyStrandsIsRefusedAtTheGroom) {
  try {
    load("skin: cube, density: 1e12");
    ADD_FAILURE();
  } catch (const Error& error) {
    EXPECT_EQ(error.kind(), ErrorKind::kInput);
    EXPECT_EQ(error.problems().front().position.line, 4);
    EXPECT_NE(std::string(error.what()).find("groom 'coat'"), std::string::npos) << error.what();
  }
}

TEST_F(GroomMessagesTest, AGroomOnHolesAloneGivesOneWarningAtTheGroom) {
  load("skin: cube, strands: 10");
  EXPECT_TRUE(warnings_.list.empty());
  // Lines of a cube whose faces are all holes.
  files_.write("cube.obj", "v 0 0 0\nv 1 0 0\nv 1 1 0\nv 0 1 0\nf 1 2 3 4\nt hole 1/0/0 0\n");
  load("skin: cube, strands: 10");
  ASSERT_EQ(warnings_.list.size(), 1u);
  for (const char* part : {"scene.yaml:4:", "groom 'coat'", "grows nothing", "holes", "skin 'cube'"})
    EXPECT_NE(warnings_.list[0].find(part), std::string::npos) << warnings_.list[0];
}

}  // namespace
}  // namespace pelage
