// SPDX-License-Identifier: Apache-2.0
#include "world/map_check.h"

#include <gtest/gtest.h>

#include "base/error.h"
#include "tests/world/small_scene.h"

namespace pelage {
namespace {

/// What is wrong with a scene whose groom has these lines, and whose materials have these colours: the lines
/// of the scene, and all text.
struct Refusal {
  std::vector<int> lines;
  std::string text;
};

class MapCheckTest : public testing::Test {
 protected:
  Refusal refusal(const std::string& groom, const std::string& hide = "0.5", const std::string& fur = "0.5") {
    files_.write("scene.yaml", R"(pelage: 1
skins: {cube: {mesh: cube.obj}, mapped: {mesh: mapped.obj}}
grooms:
  coat: {)" + groom + R"(}
materials:
  hide: {model: lambert, color: )" +
                                   hide + R"(}
  fur: {model: cone-shell, color: )" +
                                   fur + R"(}
characters:
  walker: {parts: [{skin: )" + (groom.find("mapped") < groom.size() ? "mapped" : "cube") +
                                   R"(, material: hide, grooms: {coat: fur}}]}
)");
    const SceneDescription scene = load_scene(files_.path("scene.yaml"), {});
    std::map<std::string, Assets::Skin> skins;
    skins["mapped"].cage.uv = uv_;
    skins["mapped"].cage.face_uv = {0, 1, 2};
    skins["mapped"].cage.face_sizes = {3};
    skins["cube"];
    Refusal refusal;
    try {
      check_maps(scene, skins, progress_);
    } catch (const Error& error) {
      refusal.text = error.what();
      for (const Problem& problem : error.problems()) refusal.lines.push_back(problem.position.line);
    }
    return refusal;
  }

  struct Warnings final : NoProgress {
    void warn(std::string_view line) override { lines.emplace_back(line); }
    std::vector<std::string> lines;
  };

  SmallScene files_;
  std::vector<V2f> uv_{{0, 0}, {1, 0}, {1.0001f, 1}};
  Warnings progress_;
};

using Lines = std::vector<int>;

TEST_F(MapCheckTest, FindsEveryMapOnAMeshWithoutTextureCoordinates) {
  const std::string map = "{map: spots.png}";
  const std::string in_product = "{product: [0.5, {map: spots.png, channel: r}]}";
  EXPECT_EQ(refusal("skin: cube, strands: 9").lines, Lines{});
  EXPECT_EQ(refusal("skin: cube, strands: 9, density: " + in_product).lines, Lines{4});
  EXPECT_EQ(refusal("skin: cube, strands: 9, operators: [{length: {value: " + in_product + "}}]").lines,
            Lines{4});
  EXPECT_EQ(
      refusal("skin: cube, strands: 9, operators: [{clump: {levels: [{spacing: 1, amount: " + map + "}]}}]")
          .lines,
      Lines{4});
  EXPECT_EQ(refusal("skin: cube, strands: 9", map).lines, Lines{6});
  EXPECT_EQ(refusal("skin: cube, strands: 9", "0.5", map).lines, Lines{7});
  EXPECT_EQ(refusal("skin: cube, strands: 9", "0.5", "0.5, opacity: " + map).lines, Lines{7});
  const std::string all = refusal("skin: cube, strands: 9, density: " + map).text;
  for (const char* part : {"scene.yaml:4:", "map spots.png", "mesh cube.obj", "skin 'cube'", "vt lines"})
    EXPECT_NE(all.find(part), std::string::npos) << all;
}

TEST_F(MapCheckTest, FindsRampsAlongTextureCoordinates) {
  for (const std::string axis : {"u", "v"}) {
    const std::string ramp = "{ramp: {along: " + axis + ", knots: [[0, 0.5], [1, 1]]}}";
    const std::string in_product = "{product: [0.5, " + ramp + "]}";
    const std::string density = refusal("skin: cube, strands: 9, density: " + in_product).text;
    for (const char* part : {"scene.yaml:4:", "mesh cube.obj", "skin 'cube'", "vt lines"})
      EXPECT_NE(density.find(part), std::string::npos) << density;
    EXPECT_NE(density.find("a ramp along " + axis + " is looked up"), std::string::npos) << density;
    EXPECT_EQ(refusal("skin: cube, strands: 9, operators: [{length: {value: " + ramp + "}}]").lines,
              Lines{4});
    EXPECT_EQ(refusal("skin: cube, strands: 9", ramp).lines, Lines{6});
    EXPECT_EQ(refusal("skin: cube, strands: 9", "0.5", ramp).lines, Lines{7});
    EXPECT_EQ(refusal("strands_file: a.hair", "0.5", ramp).lines, Lines{7});
    EXPECT_EQ(refusal("skin: mapped, strands: 9, density: " + ramp, ramp, ramp).lines, Lines{});
  }
}

TEST_F(MapCheckTest, AcceptsWhatNeedsNone) {
  const std::string map = "{map: spots.png}";
  EXPECT_EQ(refusal("skin: mapped, strands: 9, density: " + map, map, map).lines, Lines{});
  EXPECT_EQ(refusal("skin: cube, strands: 9, operators: [{length: {value: {noise: {}}}}]",
                    "{ramp: {along: y, knots: [[0, 1], [1, 0]]}}")
                .lines,
            Lines{});
}

TEST_F(MapCheckTest, WarnsOnceWhereAMapEnds) {
  const std::string map = "{map: spots.png}", repeated = "{map: spots.png, wrap: repeat}";
  const std::string ramp = "{ramp: {along: u, knots: [[0, 0.5], [1, 1]]}}";
  refusal("skin: mapped, strands: 9, density: " + map, map, map);
  EXPECT_TRUE(progress_.lines.empty()) << "rounded texture coordinates";
  uv_ = {{0, 0}, {3, 0}, {2, 0.5f}};
  refusal("skin: mapped, strands: 9, density: " + repeated, repeated, ramp);
  EXPECT_TRUE(progress_.lines.empty());
  refusal("skin: mapped, strands: 9", map);
  ASSERT_EQ(progress_.lines.size(), 1u);
  for (const char* part : {"scene.yaml:6:", "map spots.png", "skin 'mapped'", "(0, 0) to (3, 0.5)", "UDIM"})
    EXPECT_NE(progress_.lines[0].find(part), std::string::npos) << progress_.lines[0];
}

TEST_F(MapCheckTest, AProjectionNeedsNoTextureCoordinates) {
  const std::string map = "{map: spots.png, projection: triplanar}";
  EXPECT_EQ(refusal("skin: cube, strands: 9, density: " + map, map, map).lines, Lines{});
  EXPECT_NE(refusal("skin: cube, strands: 9", "{map: spots.png}").text.find("give the map a `projection`"),
            std::string::npos);
}

TEST_F(MapCheckTest, EveryTileOfTheSkinExists) {
  const std::string map = "{map: spots.<UDIM>.png}";
  files_.write("spots.1001.png", "");
  EXPECT_EQ(refusal("skin: mapped, strands: 9, density: " + map, map, map).lines, Lines{});
  uv_ = {{1, 1}, {2, 1}, {2, 2}};
  const Refusal missing = refusal("skin: mapped, strands: 9", map);
  EXPECT_EQ(missing.lines, Lines{6});
  for (const char* part : {"spots.<UDIM>.png has no tile 1012", "skin 'mapped'", "spots.1012.png"})
    EXPECT_NE(missing.text.find(part), std::string::npos) << missing.text;
  uv_ = {{-1, 0}, {-2, 0}, {-2, 1}};
  EXPECT_NE(refusal("skin: mapped, strands: 9", map).text.find("outside all UDIM tiles"), std::string::npos);
  EXPECT_TRUE(progress_.lines.empty()) << "tiles have no border";
}

TEST_F(MapCheckTest, StrandsOnNoSkinHaveNone) {
  const std::string map = "{map: spots.png}";
  EXPECT_EQ(refusal("strands_file: a.hair", "0.5", map).lines, Lines{7});
  EXPECT_EQ(refusal("skin: mapped, strands_file: a.hair", "0.5", map).lines, Lines{});
  EXPECT_EQ(refusal("skin: mapped, attach: none, strands_file: a.hair", "0.5", map).lines, Lines{7});
}

}  // namespace
}  // namespace pelage
