// SPDX-License-Identifier: Apache-2.0
// Pictures with the reflection cache against those of `path`.
#include <cmath>
#include <vector>

#include <gtest/gtest.h>

#include "base/parallel.h"
#include "render/fibre/medulla_tables.h"
#include "render/sampling/pixel_moments.h"
#include "tests/geom/random_strands.h"
#include "tests/render/path/path_scene.h"

namespace pelage {
namespace {

/// A small picture, whose cells have many paths.
struct Case : PathScene {
  Case() : PathScene(24, 24) {
    camera.fov = 16;
    image.filter_samples = FilterSamples::kSplatted;
    render.samples = 64;
    render.bounces = 12;
    render.gather.cache = true;
    render.gather.cache_paths = 1;
    render.gather.cells = false;
  }
  void add_key() {
    RectangleLightParams key;
    key.position = V3f(3, 3, 3);
    key.look_at = V3f(0);
    key.size = V2f(2, 2);
    key.radiance = Rgb(5);
    add_light("key", key);
  }
  PixelMoments mean_luminance(Integrator integrator, int seeds) {
    render.integrator = integrator;
    PixelMoments moments;
    for (int seed = 0; seed < seeds; ++seed) {
      render.seed = seed + (integrator == Integrator::kPath ? 1000 : 0);
      moments.add(luminance(picture_mean(run().film).mean));
    }
    return moments;
  }
  /// Four standard errors (of Student's t with 8 degrees of freedom: chance exceeds them in one of 250
  /// comparisons). Cells blur light, and may change its sum by 0.3 %.
  void expect_light_of_paths(double min_found) {
    constexpr int seeds = 5;
    const PixelMoments gathered = mean_luminance(Integrator::kGather, seeds);
    const PixelMoments traced = mean_luminance(Integrator::kPath, seeds);
    EXPECT_NEAR(gathered.mean / traced.mean, 1,
                0.003 + 4 * std::hypot(gathered.error(), traced.error()) / traced.mean);
    EXPECT_LT(std::hypot(gathered.error(), traced.error()) / traced.mean, 0.006);
    EXPECT_GT(statistics.reflections.found, min_found * static_cast<double>(statistics.reflections.lookups));
  }
};

Strands tangle() {
  RandomStrandOptions o;
  o.strands = 400;
  o.radius = 0.02f;
  o.wander = 0.3f;
  return random_strands(4, o);
}

/// All models that keep energy, white.
std::vector<MaterialParams> white_models() {
  ChiangParams chiang;
  chiang.color = Field(Rgb(1));
  DeonParams deon;
  deon.color = Field(Rgb(1));
  YanFastParams fast;
  fast.color = Field(Rgb(1));
  YanParams yan;
  yan.color = Field(Rgb(1));
  yan.made = MedullaTables::make(yan.optics(), Workers(2), 500);
  return {diffuse_fibre(Rgb(1)), chiang, deon, fast, yan};
}

double furnace_mean(const MaterialParams& model, float cache_paths) {
  Case scene;
  scene.add_fur(tangle(), model);
  scene.add_sky(Rgb(1));
  scene.camera.fov = 12;
  scene.render.bounces = 512;
  scene.render.gather.cache_paths = cache_paths;
  return scene.mean_luminance(Integrator::kGather, 4).mean;
}

/// Each cell is a mean of paths, so that a furnace stays white whatever the number of bounces.
TEST(ReflectionEnergy, AWhiteFurnaceStaysWhite) {
  for (const MaterialParams& model : white_models())
    EXPECT_NEAR(furnace_mean(model, 0.25f), 1, 0.01) << model.index();  // cells have few paths
  EXPECT_NEAR(furnace_mean(diffuse_fibre(Rgb(1)), 1), 1, 0.01);
}

TEST(ReflectionEnergy, ABallOfFurHasTheLightOfPaths) {
  for (const Rgb& color : {Rgb(0.9f), Rgb(0.4f, 0.2f, 0.1f)}) {
    Case scene;
    ChiangParams fibre;
    fibre.color = Field(color);
    scene.add_fur(furball(3000, 0.5f, 0.01f), fibre);
    scene.add_skin(sphere_mesh(1), LambertParams{});
    scene.add_key();
    scene.add_sky(Rgb(0.2f));
    scene.expect_light_of_paths(0.8);
  }
}

TEST(ReflectionEnergy, TwoCoatsOfDifferentModelsHaveTheLightOfPaths) {
  Case scene;
  ChiangParams pale;
  pale.color = Field(Rgb(0.9f));
  scene.add_fur(furball(800, 0.3f, 0.02f), pale);
  scene.add_fur(furball(300, 0.8f, 0.01f), MarschnerParams{});
  scene.add_skin(sphere_mesh(1), GlossyParams{});
  scene.add_key();
  scene.add_sky(Rgb(0.5f));
  scene.expect_light_of_paths(0.3);  // on glossy skin, paths go on
}

/// Two planes that meet at right angles: most of their light comes from each other.
SkinMesh fold() {
  SkinMesh mesh;
  const V3f left = V3f(1, 0, 1).normalized(), right = V3f(-1, 0, 1).normalized();
  const V3f corners[] = {{-1, -1, 1}, {0, -1, 0}, {0, 1, 0}, {-1, 1, 1},  // left
                         {0, -1, 0},  {1, -1, 1}, {1, 1, 1}, {0, 1, 0}};
  for (int i = 0; i < 8; ++i) {
    const V3f& normal = i < 4 ? left : right;
    mesh.positions.insert(mesh.positions.end(), {corners[i].x, corners[i].y, corners[i].z});
    mesh.normals.insert(mesh.normals.end(), {normal.x, normal.y, normal.z});
  }
  mesh.triangles = {0, 1, 2, 0, 2, 3, 4, 5, 6, 4, 6, 7};
  mesh.faces = {0, 0, 1, 1};
  mesh.vertex_uv.assign(mesh.triangles.size(), V2f(0));
  return mesh;
}

TEST(ReflectionEnergy, AFoldOfSkinHasTheLightOfPaths) {
  Case scene;
  LambertParams pale;
  pale.color = Field(Rgb(0.8f));
  scene.add_skin(fold(), pale);
  scene.camera.position = V3f(0, 0, 8);
  scene.add_key();
  scene.add_sky(Rgb(0.1f));
  scene.expect_light_of_paths(0.9);
}

}  // namespace
}  // namespace pelage
