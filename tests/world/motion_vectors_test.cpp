// SPDX-License-Identifier: Apache-2.0
// The layers forward.u and forward.v of moving scenes.
#include <functional>

#include <gtest/gtest.h>

#include "render/render_frame.h"
#include "tests/world/furry_scene.h"

namespace pelage {
namespace {

class MotionVectors : public testing::Test {
 protected:
  /// Renders the scene. Compares the motion vectors that are not 0 with `next`, which moves a point to its
  /// place in the next frame. Returns how many pixels of strands and of skins have such a vector.
  V2f check(const std::string& scene_path, std::vector<Override> overrides, double frame,
            const std::function<V3f(const V3f&)>& next) {
    QuietJob job;
    if (scene_path == scene_.scene()) overrides.push_back(kColor);
    overrides.push_back({"render.integrator", "path"});  // the picture is too coarse for other samples
    const SceneDescription scene = load_scene(scene_path, overrides);
    const auto assets = load_assets(scene, job);
    const World world = compose(scene, *assets, frame, job);
    const Camera& camera = world.scene.camera;
    const FrameResult result = render_frame(world.scene, job);
    V2f moved(0);
    for (int y = 0; y < world.scene.image.height; ++y) {
      for (int x = 0; x < world.scene.image.width; ++x) {
        const VisibleSurface& seen = result.film.surface(x, y);
        if (!std::isfinite(seen.depth) || seen.forward == V2f(0)) continue;
        moved += seen.id == kNoStrand ? V2f(0, 1) : V2f(1, 0);
        // The sample is up to half a pixel from the middle of the pixel, in both directions.
        const CameraRay ray =
            camera.ray(static_cast<float>(x) + 0.5f, static_cast<float>(y) + 0.5f, V2f(0.5f), 0);
        const V3f at = ray.origin + seen.depth / ray.direction.dot(camera.axis(0)) * ray.direction;
        const V3f from = *camera.project_at_frame(at, 0), to = *camera.project_at_frame(next(at), 1);
        const V2f expected(to.x - from.x, to.y - from.y);
        EXPECT_LT((seen.forward - expected).length(), 0.15f + 0.06f * expected.length())
            << x << ' ' << y << ": " << seen.forward << " instead of " << expected;
      }
    }
    return moved;
  }

  FurryScene scene_;
};

TEST_F(MotionVectors, OfPosesReachTheNextFrameAtAnyShutter) {
  // Frame 2: the cube walks one unit per frame, twice as large.
  for (const char* shutter : {"[0, 0]", "[0.25, 0.25]", "[-0.25, 0.25]"}) {
    const V2f moved = check(scene_.scene(), {{"camera.shutter", shutter}}, 2,
                            [](const V3f& p) { return p + V3f(2, 0, 0); });
    EXPECT_GT(moved.x, 100) << shutter;
    EXPECT_GT(moved.y, 5) << shutter;
  }
}

// The shutter sees none of a motion that begins at the frame.
TEST_F(MotionVectors, KnowWhatTheShutterDoesNotSee) {
  const V2f moved = check(scene_.scene(),
                          {{"camera.shutter", "[-0.5, 0]"},
                           {"skins.cube.poses", "null"},
                           {"characters.walker.transform.translate", "{keys: {1: [2, 1, 0], 2: [3, 1, 0]}}"}},
                          1, [](const V3f& p) { return p + V3f(1, 0, 0); });
  EXPECT_GT(moved.x, 100);
}

TEST_F(MotionVectors, TurnStrandsWithTheirCharacter) {
  const M44f turn = M44f().setEulerAngles(V3f(0, 0, 0.2f));
  const V2f moved =
      check(scene_.scene(),
            {{"camera.shutter", "[0, 0]"},
             {"skins.cube.poses", "null"},
             {"characters.walker.transform.translate", "[0, 0, 0]"},
             {"characters.walker.transform.rotate", "{keys: {1: [0, 0, 0], 3: [0, 0, 22.91831]}}"}},
            1, [&](const V3f& p) { return p * turn; });
  EXPECT_GT(moved.x, 100);
  EXPECT_GT(moved.y, 5);
}

TEST_F(MotionVectors, OfFilesReachTheNextFrame) {
  scene_.write(
      "hair.rib",
      "MotionBegin [0 2] Translate 0 0 0 Translate 1 0 0 MotionEnd\n"
      "Curves \"linear\" [2 2] \"nonperiodic\" \"P\" [0 -1 0 0 1 0 1 -1 0 1 1 0] \"constantwidth\" [0.5]\n"
      "PointsPolygons [4] [0 1 2 3] \"P\" [-2 -1 -1 0 -1 -1 0 1 -1 -2 1 -1]");
  scene_.write("rib.yaml", R"(pelage: 1
camera: {position: [0, 0, 8], look_at: [0, 0, 0], fov: 40}
image: {width: 48, height: 32}
archives: {a: {rib: hair.rib}}
lights: {sky: {type: environment}}
render: {samples: 4, bounces: 0}
)");
  const V2f moved = check(scene_.path("rib.yaml"), {}, 1, [](const V3f& p) { return p + V3f(0.5f, 0, 0); });
  EXPECT_GT(moved.x, 20);
  EXPECT_GT(moved.y, 20);
}

}  // namespace
}  // namespace pelage
