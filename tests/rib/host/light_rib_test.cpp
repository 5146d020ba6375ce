// SPDX-License-Identifier: Apache-2.0
#include <gtest/gtest.h>

#include "base/file.h"
#include "rib/host/scene_rib.h"
#include "tests/rib/syntax/rib_tokens.h"
#include "tests/world/furry_scene.h"
#include "tests/world/small_scene.h"

namespace pelage::light_rib_test {
namespace {

/// The requests of a scene with these lights.
std::vector<RibRequest> requests(const std::string& lights) {
  const FurryScene files;
  const std::vector<Override> overrides = {{"lights", lights}};
  QuietJob job;
  const SceneDescription scene = load_scene(files.scene(), overrides);
  const auto assets = load_assets(scene, job);
  const auto written =
      write_scene_rib(files.path("a.rib"), {files.scene(), overrides, scene, *assets}, {}, job);
  return rib_requests(read_file(written.at(0)));
}

const RibRequest& find(const std::vector<RibRequest>& requests, const std::string& name) {
  for (const RibRequest& request : requests) {
    if (request.name == name) return request;
  }
  throw std::runtime_error("no " + name);
}

TEST(LightRib, SunsAndSpotsAreTheStandardShaders) {
  const std::string sun = "{type: sun, direction: [1, -2, 0], irradiance: 6, angle: 20, shadowed_by: []}";
  const auto rib = requests("{sun: " + sun + "}");
  const RibRequest& distant = find(rib, "LightSource");
  EXPECT_EQ(distant.arguments[0].texts[0], "distantlight");
  // A surface that faces the light gets pi * lightcolor * intensity.
  EXPECT_NEAR(distant.parameter("color lightcolor").numbers[0] * 3.14159265, 6, 1e-5);
  EXPECT_EQ(distant.parameter("point to").numbers, (std::vector<double>{1, -2, 0}));
  EXPECT_EQ(distant.parameter("string pelage").texts[0],
            "{type: sun, direction: [1, -2, 0], irradiance: 6, angle: 20}")
      << "without links, whose names a RIB file does not have";
  const auto other = requests("{spot: {type: spot, position: [0, 3, 0], power: 100, cone: 60, exposure: 1}}");
  const RibRequest& spot = find(other, "LightSource");
  EXPECT_EQ(spot.arguments[0].texts[0], "spotlight");
  EXPECT_NEAR(spot.parameter("float coneangle").numbers[0], 3.14159265 / 6, 1e-6);
  EXPECT_NEAR(spot.parameter("float intensity").numbers[0], 2, 1e-6);
  EXPECT_NEAR(spot.parameter("color lightcolor").numbers[0], 100 / (4 * 3.14159265 * 3.14159265), 1e-5);
}

}  // namespace
}  // namespace pelage::light_rib_test
