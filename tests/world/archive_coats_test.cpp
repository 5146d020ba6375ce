// SPDX-License-Identifier: Apache-2.0
#include "world/archive_coats.h"

#include <gtest/gtest.h>

#include "geom/curve_bounds.h"
#include "rib/scene/placed_procedural.h"
#include "tests/world/furry_scene.h"
#include "world/world.h"

namespace pelage {
namespace {

const std::string kCamera = "Projection \"perspective\" \"fov\" 40 Translate 0 0 8 Scale 1 1 -1 WorldBegin\n";

class ArchiveCoats : public testing::Test {
 protected:
  struct Frame {
    SceneDescription scene;
    std::unique_ptr<Assets> assets;
    World world;
  };
  std::string request(const std::string& arguments) const {
    return "Procedural \"DynamicLoad\" [\"libpelage_ri.so\" \"" + arguments + "\"] [-9 9 -9 9 -9 9]\n";
  }
  Frame shot(const std::string& text, const std::vector<Override>& overrides = {}) {
    files_.write("shot.rib", "Shutter -0.25 0.25\n" + kCamera + text + "WorldEnd");
    SceneDescription scene = load_scene(files_.path("shot.rib"), overrides);
    auto assets = load_assets(scene, job_);
    World world = compose(scene, *assets, 2, job_);
    return {std::move(scene), std::move(assets), std::move(world)};
  }
  std::string failure(const std::string& text, const std::vector<Override>& overrides = {}) {
    try {
      shot(text, overrides);
    } catch (const Error& error) {
      return error.what();
    }
    return "no error";
  }
  static StrandsById strands_of(const FurPart& part) {
    StrandsById strands;
    for (const auto& procedural : part.procedurals) {
      const auto leaves = procedural->split();
      if (leaves.empty()) add_strands(procedural->generate(), strands);
      for (const auto& leaf : leaves) add_strands(leaf->generate(), strands);
    }
    return strands;
  }
  const FurryScene files_;
  QuietJob job_;
};

TEST_F(ArchiveCoats, AreTheStrandsOfTheScene) {
  const Frame frame = shot(request(files_.scene() + " character=walker coat=coat frame=2"));
  ASSERT_EQ(frame.world.scene.fur.size(), 1u);
  const FurPart& part = frame.world.scene.fur[0];
  EXPECT_EQ(part.name, "shot.walker.coat");
  EXPECT_EQ(strands_of(part), picture_strands(files_.scene(), "walker.coat", 2));
  EXPECT_GT(part.procedurals[0]->split().size(), 5u) << "deferred, leaf by leaf";
  EXPECT_EQ(frame.world.counts.strands_described, 900);
  EXPECT_TRUE(frame.scene.warnings.empty());
}

TEST_F(ArchiveCoats, NamesPathsAndProgramsMayBeShort) {
  // Beside the file, without character and coat, without ".so", as the program instead of the plugin.
  for (const std::string text :
       {"Procedural \"DynamicLoad\" [\"/opt/lib/libpelage_ri\" \"fur.yaml frame=2\"] [0 1 0 1 0 1]\n",
        "Procedural \"RunProgram\" [\"bin/pelage procedural\" \"fur.yaml frame=2\"] [0 1 0 1 0 1]\n",
        "Procedural2 \"DynamicLoad\" \"SimpleBound\" \"string dsoname\" [\"libpelage_ri.so\"] \"string "
        "data\" "
        "[\"fur.yaml frame=2\"] \"float[ 6 ] bound\" [0 1 0 1 0 1]\n"}) {
    const Frame frame = shot(text);
    ASSERT_EQ(frame.world.scene.fur.size(), 2u) << text;
    EXPECT_EQ(strands_of(frame.world.scene.fur[0]), picture_strands(files_.scene(), "walker.coat", 2));
    EXPECT_EQ(strands_of(frame.world.scene.fur[1]), picture_strands(files_.scene(), "post.whiskers", 2));
  }
}

TEST_F(ArchiveCoats, LeavesAreThoseOfThePlugin) {
  const std::string coat = files_.scene() + " character=walker coat=coat frame=2";
  const Frame whole = shot(request(coat));
  const auto leaves = whole.world.scene.fur[0].procedurals[0]->split();
  StrandsById expected;
  for (const size_t leaf : {4, 5, 6}) add_strands(leaves[leaf]->generate(), expected);
  const Frame some = shot(request(coat + " leaf=4-6"));
  EXPECT_EQ(strands_of(some.world.scene.fur[0]), expected);
  EXPECT_EQ(some.world.counts.strands_described, static_cast<int64_t>(expected.size()));
}

TEST_F(ArchiveCoats, LevelOfDetailIsThatOfTheArguments) {
  const std::string coat = "'" + files_.scene() +
                           "' character=walker coat=coat frame=2 set=render.lod.enabled=true " +
                           "'set=camera.position=[30, 20, 80]'";
  const std::vector<Override> far{{"render.lod.enabled", "true"}, {"camera.position", "[30, 20, 80]"}};
  const Frame same = shot(request(coat + " camera=scene"));
  const StrandsById reduced = picture_strands(files_.scene(), "walker.coat", 2, far);
  EXPECT_LT(reduced.size(), 900u);
  EXPECT_EQ(strands_of(same.world.scene.fur[0]), reduced);
  EXPECT_EQ(strands_of(shot(request(coat)).world.scene.fur[0]).size(), 900u);
  EXPECT_EQ(strands_of(shot(request(coat + " camera=scene detail=full")).world.scene.fur[0]).size(), 900u);
  const size_t few = strands_of(shot(request(coat + " scale=2")).world.scene.fur[0]).size();
  EXPECT_LT(few, 900u);
  EXPECT_GT(few, 0u);
}

TEST_F(ArchiveCoats, FollowTheTransformsOfTheFile) {
  const std::string coat = files_.scene() + " character=walker coat=coat frame=2";
  const StrandsById plain = strands_of(shot(request(coat)).world.scene.fur[0]);
  const Frame moved = shot(
      "MotionBegin [-0.25 0.25] Translate 1 2 3 Translate 1 2 4 MotionEnd Scale 2 1 0.5 " + request(coat));
  const FurPart& part = moved.world.scene.fur[0];
  const StrandsById placed = strands_of(part);
  ASSERT_EQ(placed.size(), plain.size());
  // Three keys: those of the coat, of which the transform has the first and the last.
  for (const auto& [id, strand] : plain) {
    const std::vector<float>& p = placed.at(id).points;
    ASSERT_EQ(p.size(), strand.points.size());
    const size_t per_key = p.size() / 3;
    for (size_t i = 0; i < p.size(); i += 4) {
      const auto key = static_cast<float>(i / per_key);
      EXPECT_FLOAT_EQ(p[i], strand.points[i] * 2 + 1);
      EXPECT_FLOAT_EQ(p[i + 1], strand.points[i + 1] + 2);
      EXPECT_NEAR(p[i + 2], strand.points[i + 2] / 2 + 3 + key / 2, 1e-5);  // a rounding of numbers up to 10
      EXPECT_FLOAT_EQ(p[i + 3], strand.points[i + 3]) << "the determinant is 1";
    }
  }
  for (const auto& leaf : part.procedurals[0]->split()) {
    const Strands strands = leaf->generate();
    const Box3f exact = exact_bounds(strands), claimed = leaf->bound(BoundSpan::kShutter);
    EXPECT_EQ(leaf->counts().points, strands.point_count());
    EXPECT_EQ(leaf->counts().motion_keys, 3u);
    for (int axis = 0; axis < 3; ++axis) {
      EXPECT_GE(exact.min[axis], claimed.min[axis]) << "law 4";
      EXPECT_LE(exact.max[axis], claimed.max[axis]) << "law 4";
    }
    const Box3f measured = leaf->exact_bounds(BoundSpan::kShutter, 1).whole();
    for (int axis = 0; axis < 3; ++axis) EXPECT_LE(exact.max[axis], measured.max[axis]);
  }
}

TEST_F(ArchiveCoats, ArchivesOfAScenePlaceThem) {
  files_.write("a.rib", request("fur.yaml character=walker coat=coat frame=2"));
  files_.write("s.yaml",
               "pelage: 1\ncamera: {position: [0, 1, 6], shutter: [-0.25, 0.25]}\narchives:\n"
               "  here: {rib: a.rib}\n  there: {rib: a.rib, transform: {translate: [10, 0, 0]}}\n");
  const SceneDescription scene = load_scene(files_.path("s.yaml"));
  const auto assets = load_assets(scene, job_);
  const World world = compose(scene, *assets, 1, job_);
  ASSERT_EQ(world.scene.fur.size(), 2u);
  const StrandsById here = strands_of(world.scene.fur[0]), there = strands_of(world.scene.fur[1]);
  EXPECT_EQ(here, picture_strands(files_.scene(), "walker.coat", 2));
  EXPECT_FLOAT_EQ(there.at(0).points[0], here.at(0).points[0] + 10);
}

TEST_F(ArchiveCoats, TheShutterIsThatOfThePicture) {
  const Frame still =
      shot(request(files_.scene() + " character=walker coat=coat frame=2"), {{"camera.shutter", "[0, 0]"}});
  EXPECT_EQ(strands_of(still.world.scene.fur[0]),
            picture_strands(files_.scene(), "walker.coat", 2, {{"camera.shutter", "[0, 0]"}}));
}

TEST_F(ArchiveCoats, MistakesHaveThePositionOfTheRequest) {
  const auto begins = [&](const std::string& arguments) {
    const std::string message = failure(request(arguments));
    const size_t at = message.find("shot.rib:3:1: Procedural: ");
    return at == std::string::npos ? message : message.substr(at + 26);
  };
  EXPECT_EQ(begins("fur.yaml charcter=walker"),
            "procedural: unknown argument 'charcter'; did you mean 'character'?");
  EXPECT_EQ(begins("fur.yaml character=walkre"), "there is no character 'walkre'; did you mean 'walker'?");
  EXPECT_EQ(begins("fur.yaml coat=cot frame=1"), "there is no coat 'cot'; did you mean 'coat'?");
  EXPECT_EQ(begins("fur.yaml character=walker coat=coat leaf=500"),
            begins("fur.yaml character=walker coat=coat leaf=500-500"));
  EXPECT_NE(begins("fur.yaml character=walker coat=coat leaf=500").find("there is no leaf 500"),
            std::string::npos);
  EXPECT_NE(begins("none.yaml").find("none.yaml"), std::string::npos);
  files_.write("bad.yaml", "pelage: 1\ngroms: {}\n");
  EXPECT_NE(failure(request("bad.yaml")).find("bad.yaml:2:1: unknown key 'groms'"), std::string::npos);
}

TEST_F(ArchiveCoats, TheMemoryLimitOfThePictureHolds) {
  const std::string message = failure(
      request(files_.scene() + " set=grooms.coat.strands=90000000 memory=64G"), {{"render.memory", "64M"}});
  EXPECT_NE(message.find("--memory"), std::string::npos) << message;
}

}  // namespace
}  // namespace pelage
