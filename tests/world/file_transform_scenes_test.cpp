// SPDX-License-Identifier: Apache-2.0
// Meshes and strand files with a `transform`, and coats without a skin, in scenes.
#include <gtest/gtest.h>

#include "base/error.h"
#include "geom/io/strand_file.h"
#include "tests/world/furry_scene.h"
#include "world/world.h"

namespace pelage::file_transform_scenes_test {

class FileTransformScenes : public testing::Test {
 protected:
  World composed(const std::vector<Override>& overrides) {
    const SceneDescription scene = load_scene(scene_.scene(), overrides);
    assets_ = load_assets(scene, job_);
    return compose(scene, *assets_, 1, job_);
  }
  std::string message(const std::vector<Override>& overrides) {
    try {
      composed(overrides);
    } catch (const Error& error) {
      return error.what();
    }
    return "";
  }
  static std::vector<Strands> strands_of(const World& world, const std::string& coat) {
    std::vector<Strands> all;
    for (const FurPart& part : world.scene.fur) {
      if (part.name != coat) continue;
      for (const auto& leaf : part.procedurals.front()->split()) all.push_back(leaf->generate());
    }
    return all;
  }
  FurryScene scene_;
  QuietJob job_;
  std::unique_ptr<Assets> assets_;
};

TEST_F(FileTransformScenes, HairOfMirroredAnimalsGrowsOutward) {
  for (const char* scheme : {"catmull-clark", "none"}) {
    // The cube of pose 1 is centred at x = 1 of its file, so at -2 in the world after scaling by -2 * 0.5
    // * 2.
    const World world = composed({{"skins.cube.scheme", scheme},
                                  {"skins.cube.transform", "{scale: [-2, 1, 1]}"},
                                  {"characters.walker.transform", "{}"},
                                  {"camera.shutter", "[0, 0]"}});
    const V3f middle(-2, 0, 0);
    size_t count = 0;
    for (const Strands& strands : strands_of(world, "walker.coat")) {
      for (size_t s = 0; s < strands.strand_count(); ++s, ++count) {
        const V3f root = strands.point(strands.first_point(s));
        const V3f tip = strands.point(strands.first_point(s + 1) - 1);
        EXPECT_GT((tip - root).dot(root - middle), 0) << scheme << ' ' << s;
        EXPECT_LT(root.x, 0);
      }
    }
    EXPECT_EQ(count, 900u);
  }
}

TEST_F(FileTransformScenes, StrandsWithoutASkinAreACharacterOfTheirOwn) {
  StrandArrays a;
  for (uint32_t s = 0; s < 20; ++s) {
    a.first_point.push_back(3 * s);
    a.ids.push_back(s);
    for (uint32_t p = 0; p < 3; ++p)
      a.points.insert(a.points.end(), {0.1f * float(s), 0, 0.2f * float(p), 0.02f});
  }
  a.first_point.push_back(60);
  write_strands(scene_.path("tuft.hair"), Strands(a));
  const std::vector<Override> tuft{
      {"grooms.tuft", "{strands_file: '" + scene_.path("tuft.hair") +
                          "', transform: {up: z}, operators: [{bend: {direction: [1, 0, 0], angle: 20}}]}"},
      {"characters", "{tuft: {parts: [{grooms: {tuft: fur}}], transform: {translate: [0, 5, 0]}}}"},
      kColor,
      {"camera.frame", "tuft"},
      {"camera.shutter", "[0, 0]"}};
  const World world = composed(tuft);
  const std::vector<Strands> strands = strands_of(world, "tuft.tuft");
  ASSERT_EQ(strands.size(), 1u);
  EXPECT_LT((strands[0].point(0) - V3f(strands[0].point(0).x, 5, 0)).length(), 1e-5f);
  EXPECT_GT(strands[0].point(2).y, 5.3f) << "z of the file is up";
  EXPECT_GT(strands[0].point(2).x, strands[0].point(0).x) << "bent";
  for (size_t i = 0; i < strands[0].point_count(); ++i) {
    const auto at = world.scene.camera.project(strands[0].point(i), 0);
    ASSERT_TRUE(at);
    EXPECT_TRUE(at->x > 0 && at->x < 48 && at->y > 0 && at->y < 32) << "framed";
  }
  const FrameResult picture = render(world, job_);
  float covered = 0;
  for (int y = 0; y < 32; ++y) {
    for (int x = 0; x < 48; ++x) covered += picture.film.alpha(x, y);
  }
  EXPECT_GT(covered, 1);
}

TEST_F(FileTransformScenes, MistakesAreNamed) {
  EXPECT_NE(message({{"grooms.coat.transform", "{up: z}"}}).find("`transform` needs a strands_file"),
            std::string::npos);
  EXPECT_NE(message({{"characters.post.parts", "[{grooms: {whiskers: fur}}]"}})
                .find("groom 'whiskers' grows on a skin, which its part lacks"),
            std::string::npos);
  EXPECT_NE(message({{"characters.post.parts", "[{skin: still}]"}}).find("needs the `material` of its skin"),
            std::string::npos);
  EXPECT_NE(message({{"skins.cube.transform", "{up: w}"}}).find("'w'"), std::string::npos);
}

}  // namespace pelage::file_transform_scenes_test
