// SPDX-License-Identifier: Apache-2.0
#include "lab/measure/camera_pan.h"

#include <map>
#include <string>

#include <gtest/gtest.h>

namespace pelage {
namespace {

std::map<std::string, std::string> keys_of(const SceneDescription& scene) {
  const auto pan = camera_pan(scene, 8);
  return {pan.begin(), pan.end()};
}

TEST(CameraPan, MovesTheTargetByAPixelPerFrame) {
  SceneDescription scene;
  scene.frames.frames = {5, 9};
  scene.camera.position = V3f(0, 0, 10);
  scene.camera.fov = 90.0f;  // 20 units high at the target
  scene.image.height = 40;
  auto keys = keys_of(scene);
  EXPECT_EQ(keys["frames"], "'5-12'");
  EXPECT_EQ(keys["camera.position"], "{keys: {5: [0, 0, 10], 12: [3.5, 0, 10]}}");
  EXPECT_EQ(keys["camera.look_at"], "{keys: {5: [0, 0, 0], 12: [3.5, 0, 0]}}");
  EXPECT_EQ(pan_frames(scene, 8).frames, (std::vector<int>{5, 6, 7, 8, 9, 10, 11, 12}));

  scene.camera.orthographic = 80.0f;
  scene.camera.position = Keyed<V3f>({{5, V3f(10, 0, 0)}, {9, V3f(0, 9, 0)}});
  EXPECT_EQ(keys_of(scene)["camera.position"], "{keys: {5: [10, 0, 0], 12: [10, 0, -14]}}") << "to its right";
}

}  // namespace
}  // namespace pelage
