// SPDX-License-Identifier: Apache-2.0
#include <gtest/gtest.h>

#include "tests/geom/random_strands.h"
#include "tests/render/raster/raster_scene.h"

namespace pelage {
namespace {

void expect_agreement(RasterScene& scene, double min_share = 0.998) {
  const RasterScene::Agreement seen = scene.compare(8);
  EXPECT_GE(static_cast<double>(seen.same), min_share * static_cast<double>(seen.samples))
      << seen.hits << " hits, " << seen.drawn_hits << " drawn, " << seen.traced << " traced";
  EXPECT_TRUE(seen.not_nearer);
}

Strands strands_through(const std::vector<std::vector<V3f>>& all, float radius) {
  StrandArrays a;
  a.basis = CurveBasis::kLinear;
  a.first_point = {0};
  for (const std::vector<V3f>& points : all) {
    for (const V3f& p : points) a.points.insert(a.points.end(), {p.x, p.y, p.z, radius});
    a.ids.push_back(a.first_point.size());
    a.first_point.push_back(static_cast<uint32_t>(a.points.size() / 4));
  }
  return Strands(std::move(a));
}

TEST(HostileRaster, NeedlesThatPointAtTheCamera) {
  RasterScene scene(48, 32);
  std::vector<std::vector<V3f>> needles;
  for (int i = 0; i < 40; ++i) {
    const V3f from(0.05f * static_cast<float>(i % 8) - 0.2f, 0.08f * static_cast<float>(i / 8) - 0.2f, -1);
    const V3f to_camera = V3f(0, 0, 10) - from;
    needles.push_back({from, from + 0.01f * static_cast<float>(i) * to_camera});
  }
  scene.add_fur(strands_through(needles, 0.02f), diffuse_fibre(Rgb(0.5f)));
  expect_agreement(scene);
}

TEST(HostileRaster, StrandsBesideAndBehindTheCamera) {
  RasterScene scene(48, 32);
  scene.add_fur(strands_through({{V3f(0, 0, 0), V3f(0.1f, 0.05f, 12)},
                                 {V3f(-1, 0, 9.9f), V3f(1, 0.01f, 9.9f)},
                                 {V3f(0.02f, 0, 9), V3f(-0.02f, 0, 11)},
                                 {V3f(0, 1, 11), V3f(0, -1, 11)},
                                 {V3f(-3, -1, 4), V3f(3, 1, 30)},
                                 {V3f(0, 0, 10), V3f(0, 0.2f, 8)}},
                                0.03f),
                diffuse_fibre(Rgb(0.5f)));
  expect_agreement(scene);
}

TEST(HostileRaster, StrandsWiderThanThePicture) {
  RasterScene scene(48, 32);
  scene.add_fur(strands_through({{V3f(-9, 0, -5), V3f(9, 1, -5)}, {V3f(0, -9, 0), V3f(0.5f, 9, 0)}}, 4.0f),
                diffuse_fibre(Rgb(0.5f)));
  expect_agreement(scene, 0.99);
}

TEST(HostileRaster, ManyStrandsInOnePixel) {
  RasterScene scene(48, 32);
  RandomStrandOptions o;
  o.strands = 20000;
  o.max_points = 4;
  o.step = 1e-3f;
  o.radius = 1e-4f;
  Strands strands = random_strands(5, o);
  StrandArrays a = std::move(strands).release();
  for (size_t i = 0; i < a.points.size(); i += 4) {
    for (size_t axis = 0; axis < 3; ++axis) a.points[i + axis] *= 0.01f;
  }
  scene.add_fur(Strands(std::move(a)), diffuse_fibre(Rgb(0.5f)));
  expect_agreement(scene);
}

TEST(HostileRaster, WideAnglesAndPicturesOfOnePixel) {
  for (const int size : {1, 17}) {
    RasterScene scene(size, size);
    scene.camera.fov = 150.0f;
    scene.camera.position = V3f(0, 0, 1.5f);
    RandomStrandOptions o;
    o.strands = 300;
    scene.add_fur(random_strands(8, o), diffuse_fibre(Rgb(0.5f)));
    scene.add_skin(sphere_mesh(0.5f), LambertParams{});
    expect_agreement(scene);
  }
}

TEST(HostileRaster, PointsThatAreNotFinite) {
  RasterScene scene(32, 32);
  const float inf = std::numeric_limits<float>::infinity();
  scene.add_fur(
      strands_through(
          {{V3f(0, 0, 0), V3f(inf, 0, 0)}, {V3f(NAN, 0, 0), V3f(0, 1, 0)}, {V3f(-1, 0, 0), V3f(1, 0, 0)}},
          0.05f),
      diffuse_fibre(Rgb(0.5f)));
  expect_agreement(scene);
}

}  // namespace
}  // namespace pelage
