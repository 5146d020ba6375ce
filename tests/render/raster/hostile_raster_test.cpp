// SPDX-License-Identifier: Apache-2.0
#include <cmath>

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

Strands needles_towards_the_camera() {
  std::vector<std::vector<V3f>> needles;
  for (int i = 0; i < 40; ++i) {
    const V3f from(0.05f * static_cast<float>(i % 8) - 0.2f, 0.08f * static_cast<float>(i / 8) - 0.2f, -1);
    const V3f to_camera = V3f(0, 0, 10) - from;
    needles.push_back({from, from + 0.01f * static_cast<float>(i) * to_camera});
  }
  return strands_through(needles, 0.02f);
}

Strands strands_around_the_camera() {
  return strands_through({{V3f(0, 0, 0), V3f(0.1f, 0.05f, 12)},
                          {V3f(-1, 0, 9.9f), V3f(1, 0.01f, 9.9f)},
                          {V3f(0.02f, 0, 9), V3f(-0.02f, 0, 11)},
                          {V3f(0, 1, 11), V3f(0, -1, 11)},
                          {V3f(-3, -1, 4), V3f(3, 1, 30)},
                          {V3f(0, 0, 10), V3f(0, 0.2f, 8)}},
                         0.03f);
}

Strands wider_than_the_picture() {
  return strands_through({{V3f(-9, 0, -5), V3f(9, 1, -5)}, {V3f(0, -9, 0), V3f(0.5f, 9, 0)}}, 4.0f);
}

Strands many_in_one_pixel() {
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
  return Strands(std::move(a));
}

TEST(HostileRaster, NeedlesThatPointAtTheCamera) {
  RasterScene scene(48, 32);
  scene.add_fur(needles_towards_the_camera(), diffuse_fibre(Rgb(0.5f)));
  expect_agreement(scene);
}

TEST(HostileRaster, StrandsBesideAndBehindTheCamera) {
  RasterScene scene(48, 32);
  scene.add_fur(strands_around_the_camera(), diffuse_fibre(Rgb(0.5f)));
  expect_agreement(scene);
}

TEST(HostileRaster, StrandsWiderThanThePicture) {
  RasterScene scene(48, 32);
  scene.add_fur(wider_than_the_picture(), diffuse_fibre(Rgb(0.5f)));
  expect_agreement(scene, 0.99);
}

TEST(HostileRaster, ManyStrandsInOnePixel) {
  RasterScene scene(48, 32);
  scene.add_fur(many_in_one_pixel(), diffuse_fibre(Rgb(0.5f)));
  expect_agreement(scene);
}

TEST(HostileRaster, StrandsThatFlyThroughTheCameraBehindALens) {
  RasterScene scene(48, 32);
  scene.camera.shutter = V2f(-0.25f, 0.25f);
  scene.camera.lens = LensParams{.f_stop = 1, .focal_length = 0.5f, .focus_distance = 10};
  StrandArrays a = strands_around_the_camera().release();
  const std::vector<float> still = a.points;
  a.motion_keys = 2;
  a.points.insert(a.points.end(), still.begin(), still.end());
  for (size_t i = 0; i < still.size(); i += 4) {
    a.points[i + 2] -= 3;
    a.points[still.size() + i + 2] += 3;
  }
  scene.add_fur(Strands(std::move(a)), diffuse_fibre(Rgb(0.5f)));
  expect_agreement(scene);
}

/// Mean alpha of a picture by `gather` or `path`, all of whose pixels must be finite.
double mean_alpha(RasterScene& scene) {
  const FrameResult result = scene.run({}, 2);
  EXPECT_EQ(result.statistics.samples_rejected, 0);
  double sum = 0;
  for (int y = 0; y < scene.image.height; ++y) {
    for (int x = 0; x < scene.image.width; ++x) {
      EXPECT_TRUE(std::isfinite(luminance(result.film.radiance(x, y))));
      sum += result.film.alpha(x, y);
    }
  }
  return sum / (scene.image.width * scene.image.height);
}

TEST(HostileRaster, PicturesAreFiniteAndCoverWhatPathsCover) {
  for (const auto& strands :
       {needles_towards_the_camera, strands_around_the_camera, wider_than_the_picture, many_in_one_pixel}) {
    RasterScene scene(48, 32);
    scene.render.samples = 16;
    scene.add_sky(Rgb(1));
    scene.add_fur(strands(), diffuse_fibre(Rgb(0.5f)));
    const double expected = mean_alpha(scene);
    scene.render.integrator = Integrator::kGather;
    scene.render.gather.visibility = GatherVisibility::kRays;
    EXPECT_NEAR(mean_alpha(scene), expected, 0.01);
    scene.render.gather.visibility = GatherVisibility::kRaster;
    EXPECT_NEAR(mean_alpha(scene), expected, 0.01);
    scene.render.gather.min_width = 2;
    EXPECT_NEAR(mean_alpha(scene), expected, 0.01);
  }
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
