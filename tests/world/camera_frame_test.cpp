// SPDX-License-Identifier: Apache-2.0
#include "world/camera_frame.h"

#include <algorithm>
#include <cmath>

#include <fmt/format.h>
#include <gtest/gtest.h>

#include "base/error.h"
#include "tests/world/furry_scene.h"

namespace pelage::camera_frame_test {

/// What of a picture the projected points take: 0 to 1 in each direction.
struct Taken {
  V2f min{2, 2}, max{-1, -1};
  void add(const Camera& camera, const V3f& point, float width, float height) {
    const auto at = camera.project(point, 0);
    ASSERT_TRUE(at);
    min = V2f(std::min(min.x, at->x / width), std::min(min.y, at->y / height));
    max = V2f(std::max(max.x, at->x / width), std::max(max.y, at->y / height));
  }
  float smallest_margin() const { return std::min({min.x, min.y, 1 - max.x, 1 - max.y}); }
  /// Margins on the two sides of the direction that fills the picture.
  float widest() const { return std::max(max.x - min.x, max.y - min.y); }
};

std::vector<Override> framed(const std::string& name, std::vector<Override> more = {}) {
  more.push_back({"camera.frame", name});
  more.push_back({"camera.shutter", "[0, 0]"});
  return more;
}

class CameraFrame : public testing::Test {
 protected:
  World composed(const std::vector<Override>& overrides, double frame) {
    const SceneDescription scene = load_scene(scene_.scene(), overrides);
    assets_ = load_assets(scene, job_);
    return compose(scene, *assets_, frame, job_);
  }
  /// Where the strands of a coat are in the picture.
  static Taken taken_by(const World& world, const std::string& coat) {
    Taken taken;
    const auto width = static_cast<float>(world.scene.image.width);
    const auto height = static_cast<float>(world.scene.image.height);
    for (const FurPart& part : world.scene.fur) {
      if (part.name != coat) continue;
      for (const auto& leaf : part.procedurals.front()->split()) {
        const Strands strands = leaf->generate();
        for (size_t i = 0; i < strands.point_count(); ++i)
          taken.add(world.scene.camera, strands.point(i), width, height);
      }
    }
    return taken;
  }
  std::string message(const std::vector<Override>& overrides) {
    try {
      composed(overrides, 1);
    } catch (const Error& error) {
      return error.what();
    }
    return "";
  }

  FurryScene scene_;
  QuietJob job_;
  std::unique_ptr<Assets> assets_;
};

TEST_F(CameraFrame, TheWholeCoatFillsThePictureAtAnySizeAndAspectRatio) {
  for (const double scale : {1e-3, 1.0, 1e5}) {
    for (const auto& [width, height] : {std::pair{48, 32}, {16, 64}, {96, 16}}) {
      const World world = composed(
          framed("walker", {{"characters.walker.transform.scale", fmt::format("{:g}", scale)},
                            {"characters.walker.transform.translate", fmt::format("[0, {:g}, 0]", scale)},
                            {"image.width", std::to_string(width)},
                            {"image.height", std::to_string(height)}}),
          1);
      const Taken taken = taken_by(world, "walker.coat");
      SCOPED_TRACE(fmt::format("{} {}", scale, width));
      // Only a sample of the strands is measured, so the margin may be a little smaller.
      EXPECT_GE(taken.smallest_margin(), 0.045f);
      EXPECT_GE(taken.widest(), 0.86f);
    }
  }
}

TEST_F(CameraFrame, PositionAndTargetGiveTheDirectionAndKeysTurnTheCamera) {
  const World world = composed(framed("walker", {{"camera.position", "{keys: {1: [0, 0, 1], 3: [1, 0, 0]}}"},
                                                 {"camera.look_at", "[0, 0, 0]"}}),
                               3);
  EXPECT_LT((world.camera.position.at(1) - world.camera.look_at.at(1)).normalized().dot(V3f(1, 0, 0)), 1e-5f);
  EXPECT_GT((world.scene.camera.axis(0)).dot(V3f(-1, 0, 0)), 0.99999f);
  EXPECT_EQ(world.camera.position.keys().size(), 2u);
  EXPECT_TRUE(world.camera.frame.name.empty());
  EXPECT_EQ(world.camera.fov.at(3), 40.0f);
}

TEST_F(CameraFrame, ThePoseIsThatOfTheFirstFrameOfTheFile) {
  scene_.write("later.yaml", "pelage: 1\ninclude: fur.yaml\nframes: 2-3\n");
  const auto eye = [&](const std::vector<Override>& overrides) {
    const SceneDescription scene = load_scene(scene_.path("later.yaml"), overrides);
    const auto assets = load_assets(scene, job_);
    return placed_camera(scene, *assets, job_).position.at(1);
  };
  const V3f whole = eye(framed("walker"));
  EXPECT_EQ(whole, eye(framed("walker", {{"frames", "3"}}))) << "another machine of the farm";
  EXPECT_GT((whole - composed(framed("walker"), 1).camera.position.at(1)).length(), 1.0f) << "it has walked";
}

TEST_F(CameraFrame, SkinsCharactersAndAllCanBeFramed) {
  EXPECT_GE(taken_by(composed(framed("still"), 1), "post.whiskers").widest(), 0.7f);
  const World all = composed(framed("all"), 1);
  EXPECT_GE(taken_by(all, "post.whiskers").smallest_margin(), 0.045f);
  EXPECT_GE(taken_by(all, "walker.coat").smallest_margin(), 0.045f);
}

TEST_F(CameraFrame, ParallelLinesOfSightGetTheHeightThatFits) {
  for (const char* width : {"48", "8"}) {
    const Taken taken = taken_by(
        composed(framed("walker", {{"camera.orthographic", "1"}, {"image.width", width}}), 1), "walker.coat");
    EXPECT_GE(taken.smallest_margin(), 0.045f);
    EXPECT_GE(taken.widest(), 0.8f);
  }
}

TEST_F(CameraFrame, TheExtremePointsTouchTheMargins) {
  // Two points as far apart as the picture is wide, at different depths: both are 5 % from their borders.
  CameraParams params;
  params.position = V3f(0, 0, 1);
  const FramedBall balls[] = {{V3f(-1, 0, 0), 0}, {V3f(2, 0.1f, -3), 0}};
  const Camera camera(camera_around(balls, params, 2), 1, 200, 100);
  EXPECT_NEAR(camera.project(balls[0].center, 0)->x, 10, 1e-3);
  EXPECT_NEAR(camera.project(balls[1].center, 0)->x, 190, 1e-3);
}

TEST_F(CameraFrame, AShiftedPictureShowsTheSubjectWhole) {
  for (const char* parallel : {"null", "1"}) {
    const Taken taken = taken_by(
        composed(framed("walker", {{"camera.orthographic", parallel}, {"camera.shift", "[0.3, -0.6]"}}), 1),
        "walker.coat");
    EXPECT_GE(taken.smallest_margin(), 0.045f);
    EXPECT_GE(taken.widest(), 0.8f);
  }
}

TEST_F(CameraFrame, FocusFollowsWhatItIsOn) {
  const std::vector<Override> on{
      {"camera.position", "[0, 1, 9]"},
      {"camera.look_at", "[0, 1, 0]"},
      {"camera.f_stop", "2"},
      {"camera.focus_on", "walker"},
      {"characters.walker.transform.translate", "{keys: {1: [0, 1, 0], 2: [0, 1, -3]}}"}};
  EXPECT_NEAR(composed(on, 1).scene.camera.lod_view().focus_distance, 9, 1e-4f);
  EXPECT_NEAR(composed(on, 2).scene.camera.lod_view().focus_distance, 12, 0.6f) << "its pose differs, too";
  EXPECT_NE(message({{"camera.f_stop", "2"}, {"camera.focus_on", "walker"}, {"camera.look_at", "[6, 4, 16]"}})
                .find("'walker' is behind the camera at frame 1"),
            std::string::npos);
}

TEST_F(CameraFrame, ExposureDoublesTheLights) {
  const World plain = composed({}, 1), bright = composed({{"camera.exposure", "2"}}, 1);
  for (size_t i = 0; i < plain.scene.lights.size(); ++i)
    EXPECT_FLOAT_EQ(bright.scene.lights.light(i).importance(V3f(0)),
                    4 * plain.scene.lights.light(i).importance(V3f(0)));
}

TEST_F(CameraFrame, ContradictionsAreNamed) {
  const std::pair<std::vector<Override>, const char*> cases[] = {
      {{{"camera.focal_length", "50"}}, "`focal_length` contradicts `fov`"},
      {{{"camera.f_stop", "2"}, {"camera.lens", "{f_stop: 2}"}}, "`f_stop` contradicts `lens`"},
      {{{"camera.projection", "perspective"}, {"camera.orthographic", "3"}},
       "`projection` contradicts `orthographic`"},
      {{{"camera.f_stop", "2"}, {"camera.focus_on", "walker"}, {"camera.focus_distance", "3"}},
       "`focus_on` contradicts `focus_distance`"},
      {{{"camera.focus_distance", "3"}}, "`focus_distance` needs `f_stop`"},
      {{{"camera.shift", "[1e9, 0]"}}, "expected a shift of at most 100 pictures"},
      {{{"camera.projection", "orthographic"}, {"camera.f_stop", "2"}},
       "an orthographic camera has no `f_stop`; remove it"},
      {{{"render.lod.camera", "{focal_length: 50, fov: 20}"}}, "`focal_length` contradicts `fov`"},
      {{{"camera.focus_on", "walker"}}, "`focus_on` needs `f_stop` or `lens`"},
      {{{"camera.sensor", "24"}}, "`sensor` needs `focal_length` or `f_stop`"},
      {{{"camera.f_stop", "2"}, {"camera.focus_on", "wlaker"}}, "to focus on; did you mean 'walker'?"},
      {{{"camera.projection", "ortographic"}}, "did you mean 'orthographic'?"}};
  for (const auto& [overrides, expected] : cases)
    EXPECT_NE(message(overrides).find(expected), std::string::npos) << message(overrides);
}

TEST_F(CameraFrame, TheDefaultViewIsFromTheFrontAndAbove) {
  const World world =
      composed(framed("walker", {{"camera.position", "null"}, {"camera.look_at", "null"}}), 1);
  const V3f back = -world.scene.camera.axis(0);
  EXPECT_GT(back.x, 0.3f);
  EXPECT_GT(back.y, 0.1f);
  EXPECT_GT(back.z, 0.3f);
  EXPECT_GT(default_view(V3f(0, 0, 1)).z, 0.1f);
  EXPECT_LT(default_view(V3f(0, 0, 1)).y, -0.3f);
}

TEST_F(CameraFrame, MistakesAreNamed) {
  EXPECT_NE(message(framed("wlaker"))
                .find("--set camera.frame: there is no skin or character 'wlaker' to frame; "
                      "did you mean 'walker'?"),
            std::string::npos)
      << message(framed("wlaker"));
  EXPECT_NE(message(framed("walker", {{"characters.walker.drawn", "false"}})).find("nothing to frame"),
            std::string::npos);
  EXPECT_NE(message({{"render.lod.camera", "{frame: walker}"}}).find("the camera of `lod` cannot `frame`"),
            std::string::npos);
  EXPECT_NE(message(framed("walker", {{"camera.up", "[0, 0, 1]"},
                                      {"camera.position", "[0, 0, 5]"},
                                      {"camera.look_at", "[0, 0, 0]"}}))
                .find("parallel to the up vector"),
            std::string::npos);
}

}  // namespace pelage::camera_frame_test
