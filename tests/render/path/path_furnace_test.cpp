// SPDX-License-Identifier: Apache-2.0
#include <cmath>
#include <limits>

#include <gtest/gtest.h>

#include "render/fibre/medulla_tables.h"
#include "tests/geom/random_strands.h"
#include "tests/render/path/path_scene.h"

namespace pelage {
namespace {

constexpr float kPi = 3.14159265f;

/// Each pixel is an estimate of 1.
void expect_white(const FrameResult& result, double largest_error) {
  const PictureMean picture = picture_mean(result.film);
  EXPECT_LT(picture.standard_error, largest_error);
  EXPECT_NEAR(luminance(picture.mean), 1, 4 * picture.standard_error + 1e-5);
}

TEST(PathFurnace, AnEmptySceneIsItsEnvironment) {
  PathScene scene(8, 6);
  scene.add_sky(Rgb(0.25f, 0.5f, 0.75f));
  const FrameResult result = scene.run();
  for (int y = 0; y < 6; ++y) {
    for (int x = 0; x < 8; ++x) {
      EXPECT_EQ(result.film.radiance(x, y), Rgb(0.25f, 0.5f, 0.75f));
      EXPECT_EQ(result.film.alpha(x, y), 0.0f);
      EXPECT_EQ(result.film.surface(x, y).depth, std::numeric_limits<float>::infinity());
    }
  }
  EXPECT_EQ(scene.statistics.rays.camera, 8 * 6 * 64);
  EXPECT_EQ(scene.statistics.rays.shadow, 0);
}

TEST(PathFurnace, WithoutLightsAllIsBlack) {
  PathScene scene(4, 4);
  scene.add_skin(sphere_mesh(1), LambertParams{});
  EXPECT_EQ(picture_mean(scene.run().film).mean, Rgb(0));
}

/// Direct light alone: a fibre that shadowed itself would be darker than the sky.
TEST(PathFurnace, ASingleWhiteFibreVanishes) {
  for (CurveShape shape : {CurveShape::kFlat, CurveShape::kRound}) {
    for (float slant : {0.0f, 0.6f, 1.2f}) {
      PathScene scene(24, 24);
      const V3f axis(0, std::cos(slant), std::sin(slant));
      scene.add_fur(one_strand({-8.0f * axis, -3.0f * axis, 3.0f * axis, 8.0f * axis}, 0.4f),
                    diffuse_fibre(Rgb(1)));
      scene.add_sky(Rgb(1));
      scene.camera.fov = 2.0f;  // all pixels see the fibre
      scene.render.curves = shape;
      scene.render.bounces = 0;
      const FrameResult result = scene.run();
      EXPECT_EQ(result.film.alpha(0, 0), 1.0f);
      expect_white(result, 2e-3);
    }
  }
}

TEST(PathFurnace, AllLobesOfAWhiteFibreGiveBackWhatTheyGet) {
  for (ShellVariant variant : {ShellVariant::kWigner, ShellVariant::kLiteral}) {
    PathScene scene(24, 24);
    ConeShellParams fibre;
    fibre.color = Field(Rgb(1));
    fibre.diffuse = 0.6f;
    fibre.primary = Rgb(0.25f);
    fibre.secondary = Rgb(0.15f);
    fibre.primary_tilt = 5;
    fibre.variant = variant;
    scene.add_fur(one_strand({{-1, -8, 0}, {0.3f, -3, 0}, {0.2f, 3, 0}, {-1, 8, 0}}, 0.3f), fibre);
    scene.add_sky(Rgb(1));
    scene.camera.fov = 2.0f;
    scene.render.bounces = 16;
    expect_white(scene.run(), 2e-3);
  }
}

/// Whatever shadows whatever: white fur under a white sky scatters until the light escapes.
TEST(PathFurnace, ATangleOfWhiteFibresVanishes) {
  PathScene scene(32, 32);
  RandomStrandOptions o;
  o.strands = 400;
  o.radius = 0.02f;
  o.wander = 0.3f;
  scene.add_fur(random_strands(4, o), diffuse_fibre(Rgb(1)));
  scene.add_sky(Rgb(1));
  scene.camera.fov = 12.0f;
  scene.render.bounces = 64;
  PathOptions options;
  options.roulette = false;
  const FrameResult result = scene.run(options);
  EXPECT_GT(scene.statistics.rays.indirect, scene.statistics.rays.camera / 20);
  expect_white(result, 2e-3);
}

/// Light that goes through a fibre leaves on its far side: by direct light alone, where a ray that met its
/// own fibre again would be lost.
TEST(PathFurnace, ASingleWhiteFibreOfPhysicalModelsDoesNotShadowItself) {
  ChiangParams chiang;
  chiang.color = Field(Rgb(1));
  YanFastParams fast;
  fast.color = Field(Rgb(1));
  for (const MaterialParams& material : {MaterialParams(chiang), MaterialParams(fast)}) {
    for (CurveShape shape : {CurveShape::kFlat, CurveShape::kRound}) {
      for (float slant : {0.0f, 0.9f}) {
        PathScene scene(24, 24);
        const V3f axis(0, std::cos(slant), std::sin(slant));
        scene.add_fur(one_strand({-8.0f * axis, -3.0f * axis, 3.0f * axis, 8.0f * axis}, 0.4f), material);
        scene.add_sky(Rgb(1));
        scene.camera.fov = 2.0f;
        scene.render.curves = shape;
        scene.render.bounces = 0;
        expect_white(scene.run(), 3e-3);
      }
    }
  }
}

/// The physical models return all that a fibre does not absorb, and so does a tangle of such fibres.
TEST(PathFurnace, WhiteFibresOfPhysicalModelsVanish) {
  ChiangParams chiang;
  chiang.color = Field(Rgb(1));
  DeonParams deon;
  deon.color = Field(Rgb(1));
  YanFastParams fast;
  fast.color = Field(Rgb(1));
  YanParams yan;
  yan.color = Field(Rgb(1));
  yan.made = MedullaTables::make(yan.optics(), Workers(2), 500);
  for (const MaterialParams& material :
       {MaterialParams(chiang), MaterialParams(deon), MaterialParams(fast), MaterialParams(yan)}) {
    PathScene scene(24, 24);
    RandomStrandOptions o;
    o.strands = 400;
    o.radius = 0.02f;
    o.wander = 0.3f;
    scene.add_fur(random_strands(4, o), material);
    scene.add_sky(Rgb(1));
    scene.camera.fov = 12.0f;
    scene.render.bounces = 64;
    expect_white(scene.run(), 3e-3);
  }
}

/// A ball of dense white fur on white skin: hundreds of scatterings, and nothing is lost but by their number.
TEST(PathFurnace, AWhiteFurballVanishes) {
  ChiangParams chiang;
  chiang.absorption = Rgb(0);
  YanFastParams fast;
  fast.sigma_ca = fast.sigma_ma = Rgb(0);
  YanParams yan;
  yan.sigma_ca = yan.sigma_ma = Rgb(0);
  yan.made = MedullaTables::make(yan.optics(), Workers(2), 500);
  LambertParams skin;
  skin.color = Field(Rgb(1));
  for (const MaterialParams& material : {MaterialParams(chiang), MaterialParams(fast), MaterialParams(yan)}) {
    PathScene scene(20, 20);
    scene.add_fur(furball(6000, 0.3f, 0.008f), material);
    scene.add_skin(sphere_mesh(1), skin);
    scene.add_sky(Rgb(1));
    scene.camera.fov = 12.0f;
    scene.render.bounces = 512;
    scene.render.samples = 128;
    const FrameResult result = scene.run();
    EXPECT_EQ(result.film.alpha(0, 10), 1.0f);
    EXPECT_NEAR(luminance(picture_mean(result.film).mean), 1, 0.01);
    const RayStatistics& rays = scene.statistics.rays;
    EXPECT_GT(rays.indirect, 4 * rays.camera) << "dense enough to scatter again and again";
    expect_white(result, 2.5e-3);
  }
}

/// A coarse convex mesh with smooth normals must not shadow itself, up to its silhouette.
TEST(PathFurnace, AWhiteSphereVanishes) {
  PathScene scene(32, 32);
  LambertParams white;
  white.color = Field(Rgb(1));
  scene.add_skin(sphere_mesh(1, 12), white);
  scene.add_sky(Rgb(1));
  scene.camera.fov = 12.0f;
  scene.render.bounces = 0;
  scene.render.samples = 256;
  const FrameResult result = scene.run();
  expect_white(result, 2e-3);
  for (int y = 0; y < 32; ++y) {
    for (int x = 0; x < 32; ++x) EXPECT_NEAR(luminance(result.film.radiance(x, y)), 1, 0.15) << x << ' ' << y;
  }
}

/// Irradiance of a sphere of radiance L and radius r at distance d above a plane: pi L (r / d)^2.
TEST(PathClosedForm, ASphereLightAboveAPlane) {
  PathScene scene(16, 16);
  SkinMesh floor = sphere_mesh(1);
  floor.positions = {-5, 0, -5, -5, 0, 5, 5, 0, 5, 5, 0, -5};
  floor.normals = {0, 1, 0, 0, 1, 0, 0, 1, 0, 0, 1, 0};
  floor.triangles = {0, 1, 2, 0, 2, 3};
  floor.faces = {0, 0};
  floor.vertex_uv.assign(6, V2f(0));
  LambertParams grey;
  grey.color = Field(Rgb(0.5f));
  scene.add_skin(floor, grey);
  SphereLightParams lamp;
  lamp.position = V3f(0, 3, 0);
  lamp.radius = 1;
  lamp.radiance = Rgb(2, 4, 8);
  scene.add_light("lamp", lamp);
  scene.camera.position = V3f(6, 4, 0);
  scene.camera.fov = 0.1f;
  for (DirectTechniques direct :
       {DirectTechniques::kBoth, DirectTechniques::kLightsOnly, DirectTechniques::kLobesOnly}) {
    PathOptions options;
    options.direct = direct;
    const PictureMean picture = picture_mean(scene.run(options).film);
    EXPECT_NEAR(luminance(picture.mean), 0.5 * luminance(Rgb(2, 4, 8)) / 9,
                4 * picture.standard_error + 1e-5);
    EXPECT_LT(picture.standard_error, 0.02);
  }
}

/// A diffuse fibre under a far small sphere: L = albedo cos(theta) / pi^2 * radiance * solid angle.
TEST(PathClosedForm, ASphereLightBesideAFibre) {
  for (float slant : {0.0f, 0.5f, 1.0f}) {
    PathScene scene(16, 16);
    const V3f axis(std::sin(slant), std::cos(slant), 0);
    scene.add_fur(one_strand({-9.0f * axis, -3.0f * axis, 3.0f * axis, 9.0f * axis}, 0.002f),
                  diffuse_fibre(Rgb(0.8f)));
    SphereLightParams lamp;
    lamp.position = V3f(100, 0, 0);
    lamp.radius = 2;
    lamp.radiance = Rgb(1000);
    scene.add_light("lamp", lamp);
    scene.camera.fov = 0.005f;
    const PictureMean picture = picture_mean(scene.run().film);
    const double solid_angle = 2 * kPi * (1 - std::sqrt(1 - 0.0004));
    const double expected = 0.8 * std::cos(slant) / (kPi * kPi) * 1000 * solid_angle;
    EXPECT_NEAR(luminance(picture.mean), expected, 0.002 * expected) << slant;
  }
}

}  // namespace
}  // namespace pelage
