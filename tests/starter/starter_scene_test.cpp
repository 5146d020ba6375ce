// SPDX-License-Identifier: Apache-2.0
#include "starter/starter_scene.h"

#include <gtest/gtest.h>

#include "base/error.h"

namespace pelage::starter_scene_test {

StarterScene starter(float scale, int strands = 0) {
  StarterScene result{"cow.obj", {}, coat_looks().front(), strands};
  result.shape.box = Box3f(V3f(-1, 0, -2) * scale, V3f(1, 3, 2) * scale);
  result.shape.area = 20 * scale * scale;
  return result;
}

bool has(const std::string& text, const std::string& part) { return text.find(part) != std::string::npos; }

TEST(StarterScene, NumbersAreInProportionToTheBody) {
  const std::string small = starter_scene_text(starter(1)), large = starter_scene_text(starter(100));
  EXPECT_TRUE(has(small, "length: {value: 0.227,")) << small;
  EXPECT_TRUE(has(large, "length: {value: 22.7,")) << large;
  EXPECT_TRUE(has(small, "knots: [[-2, 1], [0.8, 1], [1.8, 0.45]]")) << small;
  EXPECT_TRUE(has(large, "knots: [[-200, 1], [80, 1], [180, 0.45]]")) << large;
}

TEST(StarterScene, ABodyThatFacesBackwardsIsCombedAndSeenFromThere) {
  StarterScene turned = starter(1);
  turned.shape.facing = {2, -1};
  const std::string text = starter_scene_text(turned);
  EXPECT_TRUE(has(text, "--facing z (or --up)")) << text;
  EXPECT_TRUE(has(text, "comb: {direction: [0, -0.45, 1]")) << text;
  EXPECT_TRUE(has(text, "knots: [[-1.8, 0.45], [-0.8, 1], [2, 1]]")) << text;
}

TEST(StarterScene, MoreStrandsAreThinner) {
  EXPECT_TRUE(has(starter_scene_text(starter(1, 250000)), "width: {root: 0.00634,"))
      << starter_scene_text(starter(1));
  EXPECT_TRUE(has(starter_scene_text(starter(1, 500000)), "width: {root: 0.00317,"));
}

TEST(StarterScene, NamesThatYamlWouldMisreadAreQuoted) {
  StarterScene odd = starter(1);
  odd.mesh = "my cow's: {mesh}.obj";
  EXPECT_TRUE(has(starter_scene_text(odd), "mesh: 'my cow''s: {mesh}.obj'"));
  odd.mesh = "cow\nrender: \"x\".obj";  // must not add lines to the scene
  const std::string text = starter_scene_text(odd);
  EXPECT_TRUE(has(text, R"(coat on "cow\x0arender: \"x\".obj", by)")) << text;
  EXPECT_TRUE(has(text, R"(mesh: "cow\x0arender: \"x\".obj", scheme)")) << text;
}

TEST(StarterScene, AnimalsHaveTheirHairInProportion) {
  StarterScene fox = starter(1);
  fox.look = coat_look("fox");
  const std::string text = starter_scene_text(fox);
  EXPECT_TRUE(has(text, "fur: {preset: fox}")) << text;
  EXPECT_TRUE(has(text, "length: {value: 0.315,")) << text;  // 50 mm on a body of 400 mm
  fox.look = coat_look("human-blond");
  fox.shape.scalp = {0.5f, 2, 20};
  const std::string head = starter_scene_text(fox);
  EXPECT_FALSE(has(head, "- color:"));  // pigments colour it
  // y - z / 2 > 2, where both ramps begin at 0: y - (z + 2) / 2 > 1
  EXPECT_TRUE(has(head,
                  "density: {threshold: {add: [{ramp: {along: y, knots: [[0, 0], [3, 3]]}}, "
                  "{ramp: {along: z, knots: [[-2, 0], [2, -2]]}}]}, at: 1, width: 0.12}"))
      << head;
}

TEST(CoatLook, UnknownNamesAreRefusedWithTheNearest) {
  EXPECT_STREQ(coat_look("woolly").name, "woolly");
  try {
    coat_look("wooly");
    FAIL();
  } catch (const Error& error) {
    EXPECT_STREQ(error.what(), "--preset 'wooly' is not known; did you mean 'woolly'?");
  }
}

}  // namespace pelage::starter_scene_test
