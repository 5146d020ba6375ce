// SPDX-License-Identifier: Apache-2.0
// Lights that illuminate, or are shadowed by, some parts only, in both integrators.
#include <gtest/gtest.h>

#include "tests/render/path/path_scene.h"

namespace pelage::light_links_test {
namespace {

std::shared_ptr<const PartSet> parts(std::initializer_list<FramePart> list) {
  auto set = std::make_shared<PartSet>();
  for (const FramePart& part : list) set->add(part);
  return set;
}

/// A square of two triangles in a plane z = const, facing +z.
SkinMesh square(float x0, float x1, float z) {
  SkinMesh mesh;
  for (const V2f& p : {V2f(x0, -20), V2f(x1, -20), V2f(x1, 20), V2f(x0, 20)}) {
    mesh.positions.insert(mesh.positions.end(), {p.x, p.y, z});
    mesh.normals.insert(mesh.normals.end(), {0, 0, 1});
  }
  mesh.triangles = {0, 1, 2, 0, 2, 3};
  mesh.faces = {0, 0};
  mesh.vertex_uv.assign(6, V2f(0));
  return mesh;
}

/// A grey wall in the light of a sun of irradiance pi from the side, with another wall in between that the
/// camera does not see.
class ShadowedWall {
 public:
  ShadowedWall(Integrator integrator, bool shadows, bool is_catcher = false) : scene_(8, 8) {
    scene_.render.integrator = integrator;
    scene_.render.samples = 16;
    scene_.render.bounces = 0;
    scene_.camera.fov = 10.0f;
    LambertParams grey;
    grey.color = Field(Rgb(0.5f));
    LambertParams wall = grey;
    wall.shadow_catcher = is_catcher;
    scene_.add_skin(square(-20, 20, 0), wall);
    scene_.add_skin(square(-30, -2, 5), grey);
    SunLightParams sun;
    sun.direction = V3f(1, 0, -1);
    sun.irradiance = kPi;
    sun.shadows = shadows;
    scene_.add_light("sun", sun);
  }
  float brightness(std::shared_ptr<const PartSet> receivers, std::shared_ptr<const PartSet> casters) {
    return picture_mean(run(receivers, casters)).mean.x;
  }
  float alpha(std::shared_ptr<const PartSet> receivers, std::shared_ptr<const PartSet> casters) {
    return run(receivers, casters).alpha(4, 4);
  }

 private:
  Film run(std::shared_ptr<const PartSet> receivers, std::shared_ptr<const PartSet> casters) {
    scene_.link = [&](LightSet& lights) { lights.light(0).link(receivers, casters); };
    return std::move(scene_.run().film);
  }

  PathScene scene_;
};

constexpr FramePart kWall{true, 0}, kBlocker{true, 1};

TEST(LightLinks, DecideWhatIsLitAndWhatCastsShadows) {
  for (const Integrator integrator : {Integrator::kPath, Integrator::kGather}) {
    const float lit = 0.5f * std::sqrt(0.5f);  // albedo * irradiance / pi * cosine
    ShadowedWall wall(integrator, true);
    EXPECT_NEAR(wall.brightness({}, {}), 0, 1e-6f);
    EXPECT_NEAR(wall.brightness({}, parts({kWall, kBlocker})), 0, 1e-6f);
    EXPECT_NEAR(wall.brightness({}, parts({kWall})), lit, 2e-3f);
    EXPECT_NEAR(wall.brightness(parts({kWall}), parts({})), lit, 2e-3f);
    EXPECT_EQ(wall.brightness(parts({kBlocker}), parts({})), 0);
    ShadowedWall without(integrator, false);
    EXPECT_NEAR(without.brightness({}, {}), lit, 2e-3f);
    EXPECT_NEAR(without.brightness({}, parts({kWall, kBlocker})), lit, 2e-3f) << "omit_shadows() stays";
  }
}

TEST(LightLinks, ShadowCatchersFollowThem) {
  for (const Integrator integrator : {Integrator::kPath, Integrator::kGather}) {
    ShadowedWall wall(integrator, true, true);
    EXPECT_NEAR(wall.alpha({}, {}), 1, 1e-5f);
    EXPECT_EQ(wall.alpha({}, parts({kWall})), 0);
    EXPECT_EQ(wall.alpha(parts({kBlocker}), {}), 0);
  }
}

/// Two balls of fur in each other, with lights of which each ignores something, and many bounces.
PictureMean linked_fur(Integrator integrator, size_t lamps, uint64_t seed) {
  PathScene scene(16, 16);
  scene.render.integrator = integrator;
  scene.render.samples = 24;
  scene.render.bounces = 3;
  scene.render.seed = static_cast<int64_t>(seed);
  scene.camera.fov = 14.0f;
  scene.add_fur(furball(3000, 0.4f, 0.01f), diffuse_fibre(Rgb(0.8f, 0.6f, 0.4f)));
  scene.add_fur(furball(1000, 0.7f, 0.01f), diffuse_fibre(Rgb(0.3f, 0.6f, 0.8f)));
  for (size_t i = 0; i < lamps; ++i) {
    PointLightParams lamp;
    const float angle = 6.28f * static_cast<float>(i) / static_cast<float>(lamps);
    lamp.position = V3f(4 * std::cos(angle), 3, 4 * std::sin(angle) + 2);
    lamp.radius = 0.3f;
    lamp.power = 600 / static_cast<float>(lamps);
    scene.add_light("lamp" + std::to_string(i), lamp);
  }
  scene.add_sky(Rgb(0.3f));
  scene.link = [&](LightSet& lights) {
    for (size_t i = 0; i < lights.size(); ++i) {
      if (i % 3 == 0) lights.light(i).link(parts({{false, 0}}), {});
      if (i % 3 == 1) lights.light(i).link({}, parts({{false, 1}}));
    }
  };
  return picture_mean(scene.run().film);
}

TEST(LightLinks, GatherFindsTheMeanOfPath) {
  // With few lights, each is listed; more are in a tree.
  for (const size_t lamps : {size_t{2}, size_t{12}}) {
    double path = 0, gather = 0;
    for (uint64_t seed = 0; seed < 2; ++seed) {
      path += luminance(linked_fur(Integrator::kPath, lamps, seed).mean);
      gather += luminance(linked_fur(Integrator::kGather, lamps, seed).mean);
    }
    // Both integrators take the same camera samples, so most of the noise cancels: over ten seeds, in pairs
    // as here and in eights, the ratio differs from 1 by at most 0.2 %. This is five times as much.
    EXPECT_NEAR(gather / path, 1, 0.01) << lamps;
    EXPECT_GT(path, 0.1);
  }
}

}  // namespace
}  // namespace pelage::light_links_test
