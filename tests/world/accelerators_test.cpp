// SPDX-License-Identifier: Apache-2.0 The brightness of fur does not depend on the accelerator: compares our
// tree with Embree's curves, for a coat in full detail and for a coat thinned by level of detail.
#include <cmath>

#include <gtest/gtest.h>

#include "tests/support/quiet_job.h"
#include "tests/world/small_scene.h"
#include "world/world.h"

namespace pelage {
namespace {

class AcceleratorsTest : public testing::Test {
 protected:
  void SetUp() override {
    scene_.write("ball.yaml", R"(pelage: 1
camera: {position: [0, 0, 8], look_at: [0, 0, 0], fov: 14}
image: {width: 40, height: 40, filter: box, light_layers: false, lod_layer: true}
skins: {cube: {mesh: cube.obj}}
grooms:
  coat:
    skin: cube
    strands: 60000
    points: 5
    operators: [{length: {value: 0.2}}, {comb: {direction: [0, -0.4, 1], lift: 0.4}}, {clump: {spacing: 0.1, amount: 0.5}},
                {width: {root: 0.004, tip: 0.001}}]
materials:
  hide: {model: lambert, color: 0.3}
  fur: {model: cone-shell, color: [0.6, 0.4, 0.2], diffuse: 0.6}
characters:
  ball: {parts: [{skin: cube, material: hide, grooms: {coat: fur}}]}
lights:
  key: {type: sphere, position: [5, 8, 5], radius: 1, intensity: 30}
render: {samples: 64, bounces: 3}
)");
  }

  struct Mean {
    double value = 0, error = 0;
    double left_out = 0;  // part of the strands
  };
  /// Of the luminance, over pictures that differ by their seeds.
  Mean mean(const std::string& accel, bool detail) {
    constexpr int kPictures = 4;
    double sum = 0, squares = 0, left_out = 0, fur = 0;
    for (int i = 1; i <= kPictures; ++i) {
      const SceneDescription scene = load_scene(
          scene_.path("ball.yaml"), {{"render.accel", accel},
                                     {"render.lod.enabled", detail ? "true" : "false"},
                                     {"render.seed", std::to_string(100 * i + (accel == "fur" ? 0 : 50))}});
      MemoryLedger ledger;
      QuietJob job(2, ledger);
      const std::unique_ptr<Assets> assets = load_assets(scene, job);
      const World world = compose(scene, *assets, 0, job);
      const FrameResult result = render(world, job);
      double picture = 0;
      for (int y = 0; y < 40; ++y) {
        for (int x = 0; x < 40; ++x) {
          picture += luminance(result.film.radiance(x, y)) / 1600;
          if (result.film.surface(x, y).id == kNoStrand) continue;
          left_out += result.film.surface(x, y).left_out;
          fur += 1;
        }
      }
      sum += picture;
      squares += picture * picture;
    }
    const double value = sum / kPictures;
    const double variance = std::max(0.0, squares / kPictures - value * value) / (kPictures - 1);
    return {value, std::sqrt(variance), left_out / fur};
  }

  /// Four standard errors, and what our tree's rounding and Embree's straight pieces may make of a strand.
  void expect_same_brightness(bool detail) {
    const Mean ours = mean("fur", detail), embree = mean("embree", detail);
    const double difference = ours.value / embree.value - 1;
    const double error = std::hypot(ours.error, embree.error) / embree.value;
    EXPECT_LT(error, 0.007);
    EXPECT_LT(std::abs(difference), 4 * error + 0.003) << error;
    EXPECT_EQ(ours.left_out > 0.5, detail) << ours.left_out;
    RecordProperty("difference", std::to_string(difference));
    RecordProperty("error", std::to_string(error));
  }

  SmallScene scene_;
};

TEST_F(AcceleratorsTest, AreAsBrightOfAThinnedCoat) { expect_same_brightness(true); }
TEST_F(AcceleratorsTest, AreAsBrightOfACoatInFull) { expect_same_brightness(false); }

}  // namespace
}  // namespace pelage
