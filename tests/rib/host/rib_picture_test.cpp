// SPDX-License-Identifier: Apache-2.0
// Pelage renders the RIB file that makes Pelage grow the coats of a scene. Tests rib/host/scene_rib.h
// together with world/archive_coats.h.
#include <gtest/gtest.h>

#include "rib/host/scene_rib.h"
#include "tests/world/furry_scene.h"
#include "world/world.h"

namespace pelage {
namespace {

using Picture = std::vector<Rgb>;

class RibPicture : public testing::Test {
 protected:
  /// The file that `pelage rib` writes for frame 2.
  std::string rib_of(const std::string& name, const SceneRibOptions& options) {
    QuietJob job;
    const std::vector<Override> overrides{{"frames", "2"}};
    const SceneDescription scene = load_scene(files_.scene(), overrides);
    const auto assets = load_assets(scene, job);
    return write_scene_rib(files_.path(name), {files_.scene(), overrides, scene, *assets}, options, job)
        .at(0);
  }

  /// The picture of a scene or RIB file, with a camera of the test: a RIB file rounds the matrix of its
  /// camera.
  static Picture picture(const std::string& path, std::vector<Override> overrides = {}, int threads = 2) {
    for (const auto& [key, value] : {std::pair("position", "[3, 2, 8]"), std::pair("look_at", "[1, 0, 0]"),
                                     std::pair("up", "[0, 1, 0]"), std::pair("fov", "40")})
      overrides.push_back({std::string("camera.") + key, value});
    overrides.push_back({"materials.fur.color", "[0.6, 0.4, 0.2]"});  // the whiskers have no colours
    // `gather` shares light by places on the skin at rest, which a RIB file does not have.
    overrides.push_back({"render.integrator", "path"});
    const SceneDescription scene = load_scene(path, overrides);
    MemoryLedger ledger;
    QuietJob job(threads, ledger);
    MemoryCharge film = reserve_film(scene, job);
    const auto assets = load_assets(scene, job);
    const World world = compose(scene, *assets, 2, job);
    film = {};
    const FrameResult result = render(world, job);
    Picture pixels;
    for (int y = 0; y < 32; ++y) {
      for (int x = 0; x < 48; ++x) pixels.push_back(result.film.radiance(x, y));
    }
    return pixels;
  }

  const FurryScene files_;
};

TEST_F(RibPicture, IsThatOfTheScene) {
  const Picture scene = picture(files_.scene());
  EXPECT_GT(
      luminance(*std::max_element(scene.begin(), scene.end(),
                                  [](const Rgb& a, const Rgb& b) { return luminance(a) < luminance(b); })),
      0.1f);
  EXPECT_EQ(picture(rib_of("a.rib", {})), scene);
}

// Law 1.
TEST_F(RibPicture, IsTheSameForAllThreadsBudgetsAndBounds) {
  const std::string file = rib_of("a.rib", {});
  const Picture reference = picture(file);
  EXPECT_EQ(picture(file, {}, 1), reference);
  EXPECT_EQ(picture(file, {}, 8), reference);
  for (const char* bounds : {"linear", "exact-shutter"}) {
    EXPECT_EQ(picture(file, {{"render.memory", "12M"}, {"render.bounds", bounds}}, 4), reference) << bounds;
  }
}

}  // namespace
}  // namespace pelage
