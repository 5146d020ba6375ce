// SPDX-License-Identifier: Apache-2.0
#include "world/hair_arguments.h"

#include <gtest/gtest.h>

#include "base/error.h"

namespace pelage {
namespace {

TEST(HairArguments, AreReadInAnyOrder) {
  const HairArguments a = parse_hair_arguments(
      "  frame=-3 'my rats/rat.yaml' coat=under character=rat leaf=4-7 memory=512M camera=scene threads=2 "
      "'set=materials.fur={model: deon}' detail=full scale=2.5");
  EXPECT_EQ(a.scene, "my rats/rat.yaml");
  EXPECT_EQ(a.frame, -3);
  EXPECT_EQ(a.character, "rat");
  EXPECT_EQ(a.coat, "under");
  EXPECT_EQ(a.leaves->first, 4u);
  EXPECT_EQ(a.leaves->end, 8u);
  EXPECT_TRUE(a.scene_camera);
  EXPECT_TRUE(a.full_detail);
  EXPECT_EQ(a.pixels_per_unit, 2.5f);
  EXPECT_EQ(a.threads, 2);
  ASSERT_EQ(a.overrides.size(), 2u);
  EXPECT_EQ(a.overrides[0].key, "render.memory");
  EXPECT_EQ(a.overrides[1].value, "{model: deon}");
}

TEST(HairArguments, PrintReadsBackTheSame) {
  for (const char* text :
       {"rat.yaml", "'a b/r''at.yaml' frame=2 character=c.17 coat=x leaf=0", "r.yaml scale=0.1",
        "./r=1/r.yaml coat=a leaf=2-9 camera=scene threads=3 memory=1G 'set=a.b=''c d'''"}) {
    const std::string printed = print_hair_arguments(parse_hair_arguments(text));
    EXPECT_EQ(printed, print_hair_arguments(parse_hair_arguments(printed)));
    EXPECT_EQ(printed, text);
  }
}

TEST(HairArguments, MistakesAreNamedInOneLine) {
  const auto message = [](const char* text) {
    try {
      parse_hair_arguments(text);
    } catch (const Error& error) {
      return std::string(error.what());
    }
    return std::string("no error");
  };
  EXPECT_EQ(message(""), "procedural: the arguments name no scene file");
  EXPECT_EQ(message("a.yaml b.yaml"),
            "procedural: expected name=value, got 'b.yaml' after the scene 'a.yaml'");
  EXPECT_EQ(message("a.yaml farme=2"), "procedural: unknown argument 'farme'; did you mean 'frame'?");
  EXPECT_EQ(message("a.yaml frame=2x"), "procedural: frame=2x: expected a number");
  EXPECT_EQ(message("a.yaml leaf=2"), "procedural: leaf= needs coat=");
  EXPECT_EQ(message("a.yaml coat=c leaf=7-2"), "procedural: leaf=7-2: the last leaf comes before the first");
  EXPECT_EQ(message("a.yaml camera=main"), "procedural: camera=main: expected camera=scene");
  EXPECT_EQ(message("a.yaml detail=3"), "procedural: detail=3: expected detail=full");
  EXPECT_EQ(message("a.yaml scale=-1"), "procedural: scale=-1: expected a positive number");
  EXPECT_EQ(message("a.yaml memory=lots"), "procedural: memory=lots: expected bytes such as 512M or 4G");
  EXPECT_EQ(message("a.yaml threads=-1"), "procedural: threads=-1: expected 0 to 4096");
  EXPECT_EQ(message("'a.yaml"), "procedural: the arguments ''a.yaml' have an unpaired quote");
}

}  // namespace
}  // namespace pelage
