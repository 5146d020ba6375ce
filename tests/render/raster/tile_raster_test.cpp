// SPDX-License-Identifier: Apache-2.0
#include "render/raster/tile_raster.h"

#include <cmath>

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

/// What is seen of a moving coat in leaves of this size, from a camera at this distance in sizes of the coat.
/// `grow_first`: whether all chunks are grown before the first is drawn.
RasterScene::Agreement see_coat(int leaf_strands, float distance, std::vector<Hit>& hits,
                                bool grow_first = false) {
  const RandomCoat coat(1, {.leaf_strands = leaf_strands, .cage_levels = 3});
  RasterScene scene(48, 48);
  const Box3f box = coat.skin->bound(BoundSpan::kShutter);
  scene.camera.look_at = box.center();
  scene.camera.position = box.center() + distance * V3f(0.1f, 0.2f, 1) * box.size().length();
  scene.camera.fov = 30.0f;
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
      4, [&](int, int, const Hit&, const Hit& drawn) { hits.push_back(drawn); }, grow_first);
  EXPECT_GT(seen.hits, seen.samples / 20);
  return seen;
}

TEST(TileRaster, TheDivisionIntoChunksChangesNothing) {
  // From outside, and from among the strands, where some are too near to be drawn.
  for (const float distance : {2.0f, 0.35f}) {
    std::vector<Hit> hits[2];
    EXPECT_NE(see_coat(300, distance, hits[0]).chunks, see_coat(70, distance, hits[1]).chunks);
    ASSERT_EQ(hits[0].size(), hits[1].size());
    for (size_t i = 0; i < hits[0].size(); ++i)
      EXPECT_TRUE(RasterScene::is_same(hits[0][i], hits[1][i])) << distance << ' ' << i;
  }
}

TEST(TileRaster, TheResidentChunksChangeNothing) {
  for (const int leaf_strands : {5, 20, 70}) {
    std::vector<Hit> hits[2];
    const RasterScene::Agreement absent = see_coat(leaf_strands, 1, hits[0], false),
                                 resident = see_coat(leaf_strands, 1, hits[1], true);
    EXPECT_EQ(absent.traced, resident.traced) << leaf_strands;
    for (size_t i = 0; i < hits[0].size(); ++i)
      EXPECT_TRUE(RasterScene::is_same(hits[0][i], hits[1][i])) << leaf_strands << ' ' << i;
  }
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
      EXPECT_GE(static_cast<double>(seen.same), 0.998 * static_cast<double>(seen.samples))
          << lens << motion_keys;
      const double n = static_cast<double>(seen.samples), p = seen.coverage();
      EXPECT_NEAR(seen.drawn_coverage(), p, 3 * std::sqrt(p * (1 - p) / n));
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
  EXPECT_GE(static_cast<double>(seen.same), 0.998 * static_cast<double>(seen.samples));
}

TEST(TileRaster, ParallelLinesOfSightAgreeWithRays) {
  RasterScene scene(48, 32);
  scene.camera.orthographic = Keyed<float>(3.5f);
  scene.add_fur(random_strands(5, many(1)), diffuse_fibre(Rgb(0.5f)));
  scene.add_skin(sphere_mesh(0.5f), LambertParams{});
  const RasterScene::Agreement seen = scene.compare(16);
  EXPECT_GE(static_cast<double>(seen.same), 0.998 * static_cast<double>(seen.samples));
  EXPECT_LT(static_cast<double>(seen.traced), 0.2 * static_cast<double>(seen.samples));
}

TEST(TileRaster, ShiftedLensesAgreeWithRays) {
  RasterScene scene(48, 32);
  scene.camera.position = V3f(-2, 1.5f, 10);
  scene.camera.look_at = V3f(-2, 1.5f, 0);
  scene.camera.shift = V2f(0.4f, -0.45f);
  scene.camera.lens = LensParams{2, 0.5f, 9.5f};
  scene.camera.shutter = V2f(-0.25f, 0.25f);
  scene.camera.shutter_curve = ShutterCurve({{0, 0}, {0.5f, 1}, {1, 0}});
  scene.add_fur(random_strands(5, many(2)), diffuse_fibre(Rgb(0.5f)));
  scene.add_skin(sphere_mesh(0.5f), LambertParams{});
  const RasterScene::Agreement seen = scene.compare(16);
  EXPECT_GT(seen.hits, seen.samples / 20);
  EXPECT_GE(static_cast<double>(seen.same), 0.998 * static_cast<double>(seen.samples));
  EXPECT_LT(static_cast<double>(seen.traced), 0.2 * static_cast<double>(seen.samples));
}

TEST(TileRaster, AGroundBelowTheCameraDoesNotTraceWholeTiles) {
  RasterScene scene(48, 32);
  scene.camera.position = V3f(0, 0.3f, 10);
  scene.camera.lens = LensParams{8, 0.5f, 10};
  SkinMesh ground;
  ground.positions = {-30, -0.2f, -30, 30, -0.2f, -30, 30, -0.2f, 30, -30, -0.2f, 30};
  for (int i = 0; i < 4; ++i) ground.normals.insert(ground.normals.end(), {0, 1, 0});
  ground.triangles = {0, 2, 1, 0, 3, 2};
  ground.faces = {0, 0};
  ground.vertex_uv.resize(6, V2f(0));
  scene.add_skin(ground, LambertParams{});
  scene.add_fur(random_strands(5, many(1)), diffuse_fibre(Rgb(0.5f)));
  const RasterScene::Agreement seen = scene.compare(16);
  EXPECT_GE(static_cast<double>(seen.same), 0.998 * static_cast<double>(seen.samples));
  EXPECT_LT(static_cast<double>(seen.traced), 0.05 * static_cast<double>(seen.samples));
}

}  // namespace
}  // namespace pelage
