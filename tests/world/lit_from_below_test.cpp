// SPDX-License-Identifier: Apache-2.0
// Hair on a sheet that is lit from below: no light passes the sheet where hair grows out of it.
#include <gtest/gtest.h>

#include "render/render_frame.h"
#include "tests/support/quiet_job.h"
#include "tests/world/small_scene.h"
#include "world/compose.h"

namespace pelage {
namespace {

TEST(LitFromBelow, NoLightReachesRootsThroughTheSkin) {
  SmallScene files;
  files.write("sheet.obj", "v -1 0 -1\nv -1 0 1\nv 1 0 1\nv 1 0 -1\nf 1 2 3 4\n");
  files.write("sheet.yaml", R"(pelage: 1
camera: {position: [0, 4, 4], look_at: [0, 0, 0], fov: 10}
image: {width: 32, height: 24}
skins: {sheet: {mesh: sheet.obj, scheme: none}}
grooms:
  coat:
    skin: sheet
    strands: 3000
    operators: [{length: {value: 0.1}}, {comb: {direction: [1, 0, 0.3], lift: 0.2}}, {width: {root: 0.02, tip: 0.01}}]
materials: {hide: {model: lambert}, fur: {model: cone-shell, color: [0.5, 0.3, 0.15], diffuse: 0.6}}
characters: {animal: {parts: [{skin: sheet, material: hide, grooms: {coat: fur}}]}}
lights: {key: {type: rectangle, position: [0, -3, 0], look_at: [0, 0, 0], up: [1, 0, 0], size: [1, 1], intensity: 20}}
render: {samples: 16, bounces: 1}
)");
  for (const char* integrator : {"path", "gather"}) {
    for (const char* lod : {"true", "false"}) {
      QuietJob job;
      const SceneDescription scene = load_scene(
          files.path("sheet.yaml"), {{"render.integrator", integrator}, {"render.lod.enabled", lod}});
      const auto assets = load_assets(scene, job);
      const World world = compose(scene, *assets, 1, job);
      const FrameResult result = render_frame(world.scene, job);
      float max = 0;
      for (int y = 0; y < 24; ++y) {
        for (int x = 0; x < 32; ++x) max = std::max(max, max_component(result.film.radiance(x, y)));
      }
      EXPECT_EQ(max, 0) << integrator << ", level of detail: " << lod;
      EXPECT_EQ(result.film.alpha(16, 12), 1);
    }
  }
}

}  // namespace
}  // namespace pelage
