// SPDX-License-Identifier: Apache-2.0
#include "world/terrain.h"

#include <cmath>

#include <gtest/gtest.h>

#include "base/error.h"
#include "tests/geom/cages.h"
#include "tests/support/quiet_job.h"
#include "tests/world/furry_scene.h"

namespace pelage::terrain_test {

/// y = (x^2 + z) / 4 over [-4, 4]^2: Catmull-Clark surfaces of regular cages are cubic splines, which move a
/// parabola with knots 1 apart by 1/12 (x^2 + 1/3) / 4.
ControlMesh valley() {
  std::vector<V3f> points;
  std::vector<std::vector<uint32_t>> faces;
  for (int z = -4; z <= 4; ++z) {
    for (int x = -4; x <= 4; ++x) points.emplace_back(float(x), (float(x * x) + float(z)) / 4, float(z));
  }
  for (uint32_t z = 0; z < 8; ++z) {
    for (uint32_t x = 0; x < 8; ++x)
      faces.push_back({9 * z + x, 9 * z + 9 + x, 9 * z + 10 + x, 9 * z + x + 1});
  }
  return make_cage(points, faces);
}

TEST(Terrain, PointsAreOnTheLimitSurface) {
  const ControlMesh cage = valley();
  QuietJob job;
  const auto rest =
      std::make_shared<LimitSurface>(SurfaceTopology::create(cage, SubdivisionScheme::kCatmullClark,
                                                             BoundaryRule::kEdgeAndCorner, "valley", job),
                                     cage.positions);
  M44f twice;
  twice.setScale(2.0f);
  const Terrain terrain({{rest, twice}}, job);
  for (float x = -5.5f; x < 5.6f; x += 0.7f) {
    for (float z = -5.5f; z < 5.6f; z += 1.1f) {
      const auto at = terrain.at(x, z);
      ASSERT_TRUE(at) << x << ' ' << z;
      EXPECT_NEAR(at->height, 2 * ((x / 2) * (x / 2) + 1.0f / 3 + z / 2) / 4, 2e-5f) << x << ' ' << z;
      const V3f normal = V3f(-x / 4, 1, -0.25f).normalized();
      EXPECT_LT((at->normal - normal).length(), 1e-4f) << x << ' ' << z;
    }
  }
  EXPECT_FALSE(terrain.at(8.1f, 0));
}

TEST(Terrain, CrowdsStandOnIt) {
  FurryScene scene;
  scene.write("slope.obj", "v -50 -25 -50\nv 50 25 -50\nv 50 25 50\nv -50 -25 50\nf 1 4 3 2\n");
  std::vector<Override> overrides{
      {"skins.slope", "{mesh: '" + scene.path("slope.obj") + "', scheme: none}"},
      {"characters.slope", "{parts: [{skin: slope, material: hide}]}"},
      {"crowds.herd", "{of: [post], count: 10, area: {type: disc, radius: 30}, ground: slope, tilt: 1}"}};
  QuietJob job;
  const auto members = [&] {
    const SceneDescription description = load_scene(scene.scene(), overrides);
    return load_assets(description, job)->crowds[0];
  };
  const V3f normal = V3f(-0.5f, 1, 0).normalized();
  for (const CrowdMember& member : members()) {
    EXPECT_NEAR(member.position.y, member.position.x / 2, 1e-5f);
    const M44f matrix = placement_of(member);
    EXPECT_LT((V3f(0, 1, 0) * matrix - member.position - normal).length(), 1e-5f);
    EXPECT_NEAR(matrix.determinant(), 1, 1e-5f);
    const V3f ahead = V3f(0, 0, 1) * matrix - member.position;
    EXPECT_NEAR(ahead.dot(normal), 0, 1e-5f);
    EXPECT_GT(ahead.dot(V3f(std::sin(member.heading), 0, std::cos(member.heading))), 0.5f);
  }
  overrides.push_back({"crowds.herd.tilt", "0"});
  for (const CrowdMember& member : members()) EXPECT_EQ(member.up, V3f(0, 1, 0));
  const auto message = [&](const char* key, const char* value) {
    auto wrong = overrides;
    wrong.push_back({key, value});
    try {
      load_assets(load_scene(scene.scene(), wrong), job);
    } catch (const Error& error) {
      return std::string(error.what());
    }
    return std::string();
  };
  EXPECT_NE(message("crowds.herd.area.radius", "90").find("has no ground at"), std::string::npos);
  EXPECT_NE(message("crowds.herd.ground", "walker").find("the ground must be still"), std::string::npos);
  EXPECT_NE(message("crowds.other", "{of: [slope], count: 1, area: {type: disc, radius: 1}}")
                .find("'slope' is an animal of crowd 'other'"),
            std::string::npos);
  EXPECT_NE(message("crowds.herd.ground", "slopes").find("did you mean 'slope'?"), std::string::npos);
}

}  // namespace pelage::terrain_test
