// SPDX-License-Identifier: Apache-2.0
#include "render/frame/shadow_catcher.h"

#include <cmath>

#include <gtest/gtest.h>

#include "tests/render/path/path_scene.h"

namespace pelage::shadow_catcher_test {

/// A wall that faces the camera, with two lights on it. A ball beside the camera's view blocks light.
struct WallScene : PathScene {
  WallScene(const LambertParams& wall, bool blocked, Integrator integrator) : PathScene(16, 16) {
    SkinMesh mesh;
    mesh.positions = {-9, -9, 0, 9, -9, 0, 9, 9, 0, -9, 9, 0};
    for (int i = 0; i < 4; ++i) mesh.normals.insert(mesh.normals.end(), {0, 0, 1});
    mesh.triangles = {0, 1, 2, 0, 2, 3};
    mesh.faces = {0, 0};
    mesh.vertex_uv.assign(6, V2f(0));
    add_skin(std::move(mesh), wall);
    if (blocked) {
      add_skin(sphere_mesh(0.6f), LambertParams{});
      SkinMesh ball = sphere_mesh(0.6f);
      for (size_t i = 0; i < ball.positions.size(); i += 3) {
        ball.positions[i] += 2;
        ball.positions[i + 2] += 3;
      }
      skins.back().skin = std::make_shared<FixedSkin>(std::move(ball));
    }
    SphereLightParams key;
    key.position = V3f(4, 0, 6);
    key.radius = 0.5f;
    key.radiance = Rgb(60, 40, 20);
    add_light("key", key);
    EnvironmentLightParams sky;
    sky.radiance = Rgb(0.2f, 0.3f, 0.5f);
    sky.visible = true;
    add_light("sky", sky);
    camera.fov = 10;
    render.integrator = integrator;
    render.bounces = 0;
    render.samples = 128;
  }
};

constexpr Integrator kIntegrators[] = {Integrator::kPath, Integrator::kGather};
const Rgb kSky(0.2f, 0.3f, 0.5f);

LambertParams catcher() {
  LambertParams params;
  params.color = Field(Rgb(0.1f));
  params.shadow_catcher = true;
  return params;
}

TEST(ShadowCatcher, ShowsTheBackgroundAsItIsWhereNothingBlocksLight) {
  for (const Integrator integrator : kIntegrators) {
    WallScene scene(catcher(), false, integrator);
    const FrameResult result = scene.run();
    const Film& film = result.film;
    for (int y = 0; y < 16; ++y) {
      for (int x = 0; x < 16; ++x) {
        EXPECT_EQ(film.alpha(x, y), 0);
        EXPECT_LT((film.radiance(x, y) - kSky).length(), 1e-6f);
        EXPECT_TRUE(std::isinf(film.surface(x, y).depth)) << "it is not in data layers";
      }
    }
  }
}

TEST(ShadowCatcher, KeepsTheFractionOfLightThatADiffuseWallKeeps) {
  WallScene without_ball(LambertParams{}, false, Integrator::kPath);
  WallScene with_ball(LambertParams{}, true, Integrator::kPath);
  const FrameResult lit = without_ball.run(), dark = with_ball.run();
  const Film &open = lit.film, &shadowed = dark.film;
  for (const Integrator integrator : kIntegrators) {
    WallScene scene(catcher(), true, integrator);
    const FrameResult result = scene.run();
    const Film& caught = result.film;
    float darkest = 1;
    for (int y = 0; y < 16; y += 4) {
      for (int x = 0; x < 16; x += 4) {
        Rgb with(0), without(0), seen(0);
        float alpha = 0;
        for (int i = 0; i < 16; ++i) {
          const int px = x + i % 4, py = y + i / 4;
          with += shadowed.radiance(px, py);
          without += open.radiance(px, py);
          seen += caught.radiance(px, py) / 16.0f;
          alpha += caught.alpha(px, py) / 16.0f;
        }
        const Rgb kept = with / without;
        for (int c = 0; c < 3; ++c) EXPECT_NEAR(seen[c] / kSky[c], kept[c], 0.02f) << x << " " << y;
        EXPECT_NEAR(alpha, 1 - luminance(kept), 0.02f);
        darkest = std::min(darkest, luminance(kept));
      }
    }
    EXPECT_LT(darkest, 0.6f) << "the ball's shadow is in the picture";
  }
}

TEST(ShadowCatcher, OtherRaysMeetASkinOfItsColour) {
  const auto light_of_ball = [](bool is_catcher) {
    LambertParams wall;
    wall.color = Field(Rgb(0.8f));
    wall.shadow_catcher = is_catcher;
    WallScene scene(wall, true, Integrator::kPath);
    scene.camera.position = V3f(2, 0, 9);
    scene.camera.look_at = V3f(2, 0, 0);
    scene.camera.fov = 3;
    scene.render.bounces = 2;
    return picture_mean(scene.run().film).mean;
  };
  EXPECT_EQ(light_of_ball(true), light_of_ball(false));
}

}  // namespace pelage::shadow_catcher_test
