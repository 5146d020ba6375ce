// SPDX-License-Identifier: Apache-2.0
#include "render/raster/tile_raster.h"

#include <gtest/gtest.h>

#include "procedurals/fur.h"
#include "tests/geom/random_strands.h"
#include "tests/procedurals/random_coats.h"
#include "tests/render/raster/raster_scene.h"

namespace pelage {
namespace {

TEST(TileRaster, SeesTheStrandsAndSkinsThatRaysMeet) {
  for (const CurveBasis basis : {CurveBasis::kPinnedBSpline, CurveBasis::kCatmullRom, CurveBasis::kLinear}) {
    RasterScene scene(64, 48);
    RandomStrandOptions o;
    o.basis = basis;
    o.strands = 2000;
    o.radius = 0.01f;
    scene.add_fur(random_strands(3, o), diffuse_fibre(Rgb(0.5f)));
    scene.add_skin(sphere_mesh(0.6f), LambertParams{});
    const RasterScene::Agreement seen = scene.compare(16);
    EXPECT_GT(seen.hits, seen.samples / 5);
    EXPECT_GE(static_cast<double>(seen.same), 0.998 * static_cast<double>(seen.samples)) << int(basis);
    EXPECT_LT(static_cast<double>(seen.traced), 0.1 * static_cast<double>(seen.samples)) << int(basis);
  }
}

TEST(TileRaster, TheDivisionIntoChunksChangesNothing) {
  const RandomCoat coat(1, {.cage_levels = 3});
  std::vector<Hit> hits[2];
  for (const bool small : {false, true}) {
    RasterScene scene(48, 48);
    const Box3f box = coat.skin->bound(BoundSpan::kShutter);
    scene.camera.look_at = box.center();
    scene.camera.position = box.center() + V3f(0.2f, 0.4f, 2) * box.size().length();
    scene.camera.fov = 30.0f;
    scene.render.memory.bytes = uint64_t(small ? 16 : 1024) << 20;
    scene.fur.resize(1);
    scene.fur[0].name = "ball.coat";
    scene.fur[0].procedurals.push_back(std::make_unique<FurProcedural>(coat.groom, coat.skin));
    scene.fur[0].material = scene.add_material(diffuse_fibre(Rgb(0.5f)));
    SkinPart skin;
    skin.name = "ball.skin";
    skin.skin = coat.skin;
    skin.rest = coat.rest;
    skin.material = scene.add_material(LambertParams{});
    scene.skins.push_back(skin);
    const RasterScene::Agreement seen = scene.compare(
        4, [&](int, int, const Hit&, const Hit& drawn) { hits[small ? 1 : 0].push_back(drawn); });
    EXPECT_GT(seen.hits, seen.samples / 20);
    EXPECT_GE(static_cast<double>(seen.same), 0.998 * static_cast<double>(seen.samples));
  }
  ASSERT_EQ(hits[0].size(), hits[1].size());
  for (size_t i = 0; i < hits[0].size(); ++i) EXPECT_TRUE(RasterScene::is_same(hits[0][i], hits[1][i])) << i;
}

RandomStrandOptions many(int motion_keys, float radius = 0.01f) {
  RandomStrandOptions o;
  o.strands = 1500;
  o.motion_keys = motion_keys;
  o.radius = radius;
  return o;
}

TEST(TileRaster, HalfTransparentStrandsStopTheSameRays) {
  RasterScene scene(48, 32);
  ConeShellParams fibre = diffuse_fibre(Rgb(0.5f));
  fibre.opacity = Field(0.4f);
  scene.add_fur(random_strands(4, many(1)), fibre);
  scene.add_skin(sphere_mesh(0.5f), LambertParams{});
  const RasterScene::Agreement seen = scene.compare(16);
  EXPECT_GE(static_cast<double>(seen.same), 0.998 * static_cast<double>(seen.samples));
}

TEST(TileRaster, MotionAndLensAgreeWithRays) {
  for (const bool lens : {false, true}) {
    for (const int motion_keys : {1, 2, 4}) {
      RasterScene scene(48, 32);
      scene.camera.shutter = V2f(-0.25f, 0.25f);
      if (lens) scene.camera.lens = LensParams{2, 0.5f, 9.5f};
      scene.add_fur(random_strands(5, many(motion_keys)), diffuse_fibre(Rgb(0.5f)));
      scene.add_skin(sphere_mesh(0.5f), LambertParams{});
      const RasterScene::Agreement seen = scene.compare(16);
      EXPECT_GE(static_cast<double>(seen.same), 0.99 * static_cast<double>(seen.samples))
          << lens << motion_keys;
      EXPECT_NEAR(seen.drawn_coverage(), seen.coverage(), 0.002);
      EXPECT_LT(static_cast<double>(seen.traced), 0.2 * static_cast<double>(seen.samples));
    }
  }
}

TEST(TileRaster, MovingCamerasAgreeWithRays) {
  RasterScene scene(48, 32);
  scene.camera.shutter = V2f(-0.5f, 0.5f);
  scene.camera.position =
      Keyed<V3f>(std::vector<std::pair<double, V3f>>{{0, V3f(-0.5f, 0, 10)}, {2, V3f(0.5f, 0.2f, 9.5f)}});
  scene.add_fur(random_strands(6, many(1)), diffuse_fibre(Rgb(0.5f)));
  scene.add_skin(sphere_mesh(0.5f), LambertParams{});
  const RasterScene::Agreement seen = scene.compare(16);
  EXPECT_GE(static_cast<double>(seen.same), 0.99 * static_cast<double>(seen.samples));
}

}  // namespace
}  // namespace pelage
