// SPDX-License-Identifier: Apache-2.0
#include "world/dark_lights.h"

#include <gtest/gtest.h>

#include "base/parallel.h"
#include "base/progress.h"
#include "tests/world/small_scene.h"
#include "world/world.h"

namespace pelage {
namespace {

/// Adds lights to the small scene.
SceneDescription with_lights(const SmallScene& scene, const std::string& lights) {
  scene.write("lit.yaml", "include: scene.yaml\nlights:\n" + lights);
  return load_scene(scene.path("lit.yaml"));
}

class LightWarnings : public NoProgress {
 public:
  void warn(std::string_view line) override { lines += std::string(line) + "\n"; }
  std::string lines;
};

TEST(DarkLights, ClosedBarnDoorsAreNamedWithTheirPlace) {
  const SmallScene scene;
  const SceneDescription found = with_lights(scene, R"(  open:
    type: rectangle
    position: [0, 5, 0]
    look_at: [0, 0, 1]
    barn_doors: {length: 1, left: -20, right: 10}
  closed:
    type: rectangle
    position: [0, 5, 0]
    look_at: [0, 0, 1]
    barn_doors: {length: 1, top: -40, bottom: -40}
  off: {type: sphere, intensity: 0}
)");
  ASSERT_EQ(found.warnings.size(), 1u);
  EXPECT_EQ(to_string(found.warnings[0].position), scene.path("lit.yaml") + ":12:17");
  EXPECT_EQ(found.warnings[0].message, "the barn doors are closed: no light passes between them");
  EXPECT_FALSE(why_dark(found));
}

TEST(DarkLights, ASpotWithoutLightInItsConeIsNamed) {
  const SmallScene scene;
  scene.write("up.ies", "IESNA:LM-63-1995\nTILT=NONE\n1 1000 1 3 1 1 2 0 0 0\n1 1 50\n0 90 180\n0\n0 0 9\n");
  const SceneDescription found =
      with_lights(scene, R"(  down: {type: spot, position: [0, 5, 0], look_at: [0, 0, 1], profile: up.ies}
  all: {type: point, position: [0, 5, 0], profile: up.ies}
)");
  EXPECT_TRUE(found.warnings.empty());
  Workers workers(1);
  MemoryLedger ledger;
  LightWarnings warnings;
  const Job job{workers, ledger, warnings};
  const auto assets = load_assets(found, job);
  compose(found, *assets, 1, job);
  EXPECT_EQ(warnings.lines,
            scene.path("lit.yaml") + ":3:72: the profile has no light within the cone of the spot\n");
}

}  // namespace
}  // namespace pelage
