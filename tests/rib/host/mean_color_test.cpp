// SPDX-License-Identifier: Apache-2.0
#include <gtest/gtest.h>

#include "geom/limit_surface.h"
#include "rib/host/scene_rib.h"
#include "tests/world/small_scene.h"
#include "world/world.h"

namespace pelage {
namespace {

/// Two triangles in the plane z = 0, with areas 0.5 and 1 and middles at x = 1/3 and 4/3.
LimitSurface two_triangles() {
  ControlMesh mesh;
  mesh.positions = {{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {3, 0, 0}};
  mesh.face_sizes = {3, 3};
  mesh.face_vertices = {0, 1, 2, 1, 3, 2};
  return {SurfaceTopology::create(mesh, SubdivisionScheme::kNone, BoundaryRule::kEdgeAndCorner, "test"),
          mesh.positions};
}

Field field(const std::string& text) {
  const SmallScene files;
  const SceneDescription scene = load_scene(files.path("scene.yaml"), {{"materials.hide.color", text}});
  return std::get<LambertParams>(scene.materials.find("hide")->value).color;
}

TEST(MeanColor, IsWeightedByArea) {
  // (0.5 * 1/3 + 1 * 4/3) / 1.5 = 1, scaled by 0.1.
  const Rgb mean =
      mean_color(field("{ramp: {along: x, knots: [[0, [0, 0, 0]], [3, [0.3, 0.3, 0.6]]]}}"), two_triangles());
  EXPECT_NEAR(mean.x, 0.1, 1e-6);
  EXPECT_NEAR(mean.z, 0.2, 1e-6);
  EXPECT_EQ(mean_color(field("[0.1, 0.2, 0.3]"), two_triangles()), Rgb(0.1f, 0.2f, 0.3f));
}

TEST(MeanColor, SkinsWithoutAreaHaveTheMeanOfTheirFaces) {
  const LimitSurface surface = two_triangles();
  const LimitSurface flat(surface.shared_topology(),
                          std::vector<V3f>{{1, 0, 0}, {1, 0, 0}, {1, 0, 0}, {1, 0, 0}});
  EXPECT_NEAR(mean_color(field("{ramp: {along: x, knots: [[0, 0], [2, 1]]}}"), flat).x, 0.5, 1e-6);
}

}  // namespace
}  // namespace pelage
