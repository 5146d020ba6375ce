// SPDX-License-Identifier: Apache-2.0
// Pictures of scenes that are moved, and of scenes that are larger or smaller.
#include "world/scene_origin.h"

#include <cmath>

#include <fmt/format.h>
#include <gtest/gtest.h>

#include "render/render_frame.h"
#include "tests/world/furry_scene.h"

namespace pelage {
namespace {

class Listener final : public Progress {
 public:
  void begin(std::string_view, double) override {}
  void advance(double) override {}
  void end() override {}
  bool cancelled() const override { return false; }
  void warn(std::string_view line) override { warnings.emplace_back(line); }

  std::vector<std::string> warnings;
};

class SceneOrigin : public testing::Test {
 protected:
  /// The furry scene, first scaled about the origin, then moved by `at` along each axis with these signs.
  std::vector<Override> placed(float scale, float at) const {
    const auto point = [&](float x, float y, float z) {
      return fmt::format("[{:.9g}, {:.9g}, {:.9g}]", scale * x + at, scale * y - at, scale * z + at);
    };
    const auto number = [&](float x) { return fmt::format("{:.9g}", scale * x); };
    return {{"camera.position", point(3, 2, 8)},
            {"camera.look_at", point(1, 0, 0)},
            {"characters.walker.transform.translate", point(0, 1, 0)},
            {"characters.walker.transform.scale", number(2)},
            {"characters.post.transform", "{translate: " + point(0, 0, 0) + ", scale: " + number(1) + "}"},
            {"lights.key.position", point(5, 8, 5)},
            {"lights.key.look_at", point(0, 0, 0)},
            {"lights.key.size", "[" + number(2) + ", " + number(1) + "]"},
            {"lights.ball.position", point(-5, 2, 1)},
            {"lights.ball.radius", number(0.5f)},
            kColor};
  }
  FrameResult picture(const std::vector<Override>& overrides) {
    const SceneDescription scene = load_scene(scene_.scene(), overrides);
    const Job job{workers_, ledger_, listener_};
    const auto assets = load_assets(scene, job);
    const World world = compose(scene, *assets, 2, job);
    origin_ = world.scene.origin;
    to_camera_ = world.scene.camera.world_to_camera();
    return render_frame(world.scene, job);
  }
  static double mean(const FrameResult& result) {
    double sum = 0;
    for (int y = 0; y < 32; ++y) {
      for (int x = 0; x < 48; ++x) sum += luminance(result.film.radiance(x, y));
    }
    return sum;
  }

  FurryScene scene_;
  MemoryLedger ledger_;
  Workers workers_{2};
  Listener listener_;
  V3f origin_{0};
  M44f to_camera_;
};

TEST_F(SceneOrigin, FarScenesHaveThePixelsOfNearOnes) {
  constexpr float kFar = 0x1p17f;  // a multiple of the steps of origins, so that nothing is rounded
  const FrameResult near = picture(placed(1, 0));
  EXPECT_EQ(origin_, V3f(0));
  const M44f to_camera = to_camera_;
  const FrameResult far = picture(placed(1, kFar));
  EXPECT_EQ(origin_, V3f(kFar, -kFar, kFar));
  EXPECT_TRUE(listener_.warnings.empty());
  const auto a = near.film.exr_rows(0, 32), b = far.film.exr_rows(0, 32);
  for (size_t i = 0; i < a.size(); ++i) {
    EXPECT_EQ(a[i].pixels, b[i].pixels) << a[i].name;
    EXPECT_EQ(a[i].ids, b[i].ids) << a[i].name;
  }
  // The header tells where the camera is in the world.
  EXPECT_LT((V3f(1, 2, 3) * to_camera - (V3f(1, 2, 3) + V3f(kFar, -kFar, kFar)) * to_camera_).length(),
            0.05f);
}

TEST_F(SceneOrigin, LargeAndTinyScenesHaveTheMeanOfTheScene) {
  const double whole = mean(picture(placed(1, 0)));
  for (const float scale : {1e-6f, 1e-3f, 1e6f})
    EXPECT_NEAR(mean(picture(placed(scale, 0))) / whole, 1, 3e-3) << scale;
  EXPECT_TRUE(listener_.warnings.empty());
}

TEST_F(SceneOrigin, CoatsWhoseOwnPlaceIsRoundedGiveOneWarning) {
  for (const float at : {1e4f, 1e7f}) {
    const SceneDescription scene = load_scene(scene_.scene(), placed(1, at));
    load_assets(scene, {workers_, ledger_, listener_});
    ASSERT_EQ(listener_.warnings.size(), at > 1e6f ? 1u : 0u) << at;
  }
  EXPECT_NE(listener_.warnings[0].find("walker is 1e+07 units from the origin"), std::string::npos)
      << listener_.warnings[0];
}

// Strands of a RIB file, in a scene without other coats.
TEST_F(SceneOrigin, FollowsTheStrandsOfFiles) {
  const auto rib = [](float at) {
    return fmt::format(
        "Translate {0:.9g} 0 0 Curves \"linear\" [2] \"nonperiodic\" \"P\" [0 0 0 0 1 0] "
        "\"constantwidth\" [0.25]",
        at);
  };
  for (const float at : {0.0f, 0x1p17f}) {
    scene_.write("hair.rib", rib(at));
    scene_.write("rib.yaml",
                 fmt::format("pelage: 1\ncamera: {{position: [{:.9g}, 0, 4], look_at: [{:.9g}, 0, 0]}}\n"
                             "archives: {{a: {{rib: hair.rib}}}}\n",
                             at, at));
    const SceneDescription scene = load_scene(scene_.path("rib.yaml"));
    const Job job{workers_, ledger_, listener_};
    const auto assets = load_assets(scene, job);
    const World world = compose(scene, *assets, 1, job);
    EXPECT_EQ(world.scene.origin, V3f(at, 0, 0));
    EXPECT_EQ(world.scene.camera.position(0), V3f(0, 0, 4));
    const auto strands = world.scene.fur.at(0).procedurals.at(0)->generate();
    EXPECT_EQ(strands.point(1), V3f(0, 1, 0));
  }
}

}  // namespace
}  // namespace pelage
