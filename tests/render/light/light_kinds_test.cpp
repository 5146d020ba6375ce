// SPDX-License-Identifier: Apache-2.0
// Disks, spots, suns and images on lights: sampling, density and brightness.
#include <gtest/gtest.h>

#include "base/error.h"
#include "image/texture_library.h"
#include "render/light/disk_light.h"
#include "render/light/light_params.h"
#include "render/light/mesh_light.h"
#include "render/light/rectangle_light.h"
#include "render/light/spot_light.h"
#include "render/light/sun_light.h"
#include "tests/render/light/light_checks.h"
#include "tests/render/random.h"
#include "tests/render/sphere_statistics.h"

namespace pelage::light_kinds_test {
namespace {

constexpr float kDegree = kPi / 180;

TEST(SunLight, PassesChiSquareAndAgrees) {
  const V3f toward = V3f(1, 2, -0.5f).normalized();
  for (const float degrees : {0.2f, 5.0f, 60.0f, 90.0f}) {
    const SunLight sun("sun", toward, degrees * kDegree, Rgb(2, 1, 0.5f), true);
    expect_agreement(sun, V3f(3, 4, 5));
    TestRandom random(8);
    SphereTestSize size;
    if (degrees < 1) continue;  // floats do not resolve the cells of so small a cone
    size.z_low = std::cos(double{degrees} * kDegree);
    const ChiSquare test = sphere_chi_square(
        SphereGrid(toward),
        [&](int) -> std::optional<V3f> { return sun.sample(V3f(0), random.unit2())->direction; },
        [&](const V3f& w) { return sun.pdf(V3f(0), w); }, size);
    EXPECT_GT(test.p, sidak_level(1e-3, 3)) << degrees << ": " << test.statistic << " / " << test.dof;
  }
}

TEST(SunLight, HasTheIrradianceOfItsCone) {
  // pi * radiance * sin^2 of the half angle on a surface that faces the disc.
  const V3f toward(0, 0, 1);
  for (const float degrees : {0.01f, 0.265f, 20.0f, 90.0f}) {
    const SunLight sun("sun", toward, degrees * kDegree, Rgb(1), true);
    const double sine = std::sin(double{degrees} * kDegree);
    EXPECT_NEAR(irradiance(sun, V3f(0), toward, 20000) / (kPi * sine * sine), 1, 0.01) << degrees;
    EXPECT_NEAR(sun.importance(V3f(0)) / (2 * kPi * 2 * std::pow(std::sin(degrees * kDegree / 2), 2)), 1,
                1e-4);
  }
}

TEST(DiskLight, AgreesAndPassesChiSquareInItsPlane) {
  const V3f normal = V3f(1, 1, 2).normalized(), center(1, 2, -1);
  V3f x, y;
  complete_frame(normal, x, y);
  const DiskLight disk("disk", center, normal, 0.8f, Rgb(2, 1, 0.5f), true);
  const V3f places[] = {center + 2.0f * normal, center + 0.1f * normal + 0.3f * x,
                        center + 0.3f * normal + 2.0f * y, center + 40.0f * normal + 10.0f * x};
  for (const V3f& from : places) {
    expect_agreement(disk, from);
    constexpr int kRings = 20, kSectors = 20, kSteps = 12, kSamples = 100000;
    std::vector<double> observed(kRings * kSectors + 1), expected(kRings * kSectors + 1);
    TestRandom random(21);
    for (int i = 0; i < kSamples; ++i) {
      const auto s = disk.sample(from, random.unit2());
      if (!s) {
        ++observed.back();
        continue;
      }
      const V3f at = from + s->distance * s->direction - center;
      const double ring = at.length2() / (0.8 * 0.8) * kRings;
      const double turn = std::atan2(at.dot(y), at.dot(x)) / (2 * std::numbers::pi) + 0.5;
      const auto cell = [](double place, int count) {
        return std::clamp(static_cast<int>(place), 0, count - 1);
      };
      ++observed[cell(ring, kRings) * kSectors + cell(turn * kSectors, kSectors)];
    }
    double inside = 0;
    const double area = std::numbers::pi * 0.8 * 0.8 / (kRings * kSteps * kSectors * kSteps);
    for (int i = 0; i < kRings * kSteps; ++i) {
      for (int j = 0; j < kSectors * kSteps; ++j) {
        const double r = 0.8 * std::sqrt((i + 0.5) / (kRings * kSteps));
        const double phi = 2 * std::numbers::pi * ((j + 0.5) / (kSectors * kSteps) - 0.5);
        const V3f to = center + static_cast<float>(r * std::cos(phi)) * x +
                       static_cast<float>(r * std::sin(phi)) * y - from;
        const V3f w = to.normalized();
        const double mass = disk.pdf(from, w) * std::abs(w.dot(normal)) / to.length2() * area;
        expected[i / kSteps * kSectors + j / kSteps] += kSamples * mass;
        inside += mass;
      }
    }
    expected.back() = kSamples * std::max(0.0, 1 - inside);
    if (expected.back() < 100) expected.back() = observed.back();  // only the error of the integral
    const ChiSquare test = chi_square(observed, expected);
    EXPECT_GT(test.p, sidak_level(1e-3, 4)) << from << ": " << test.statistic << " / " << test.dof;
  }
}

TEST(DiskLight, HasTheIrradianceOfADiskOnItsAxis) {
  // pi * radiance * sin^2 of the angle between the axis and the border.
  for (const float distance : {0.05f, 0.5f, 3.0f, 100.0f}) {
    const DiskLight disk("disk", V3f(0), V3f(0, 0, 1), 1, Rgb(1), true);
    const double expected = kPi / (1.0 + double{distance} * distance);
    EXPECT_NEAR(irradiance(disk, V3f(0, 0, distance), V3f(0, 0, -1), 40000) / expected, 1, 0.015) << distance;
    EXPECT_EQ(irradiance(disk, V3f(0, 0, -distance), V3f(0, 0, 1), 10), 0) << "behind";
  }
}

SpotLight spot(float half_degrees, float softness, std::shared_ptr<const Texture> gobo = {}) {
  SpotCone cone{{1, 0, 0}, {0, 0, 1}, {0, -1, 0}, half_degrees * kDegree, softness, std::move(gobo)};
  return {"spot", V3f(0, 4, 0), 0.05f, cone, Rgb(1000), true};
}

TEST(SpotLight, CutsTheLightOfASphereToItsCone) {
  const SpotLight hard = spot(20, 0), soft = spot(20, 0.5f);
  const V3f below(0), up(0, 1, 0);
  const double full = kPi * 1000 * 0.05 * 0.05 / 16;
  EXPECT_NEAR(irradiance(hard, below, up, 2000) / full, 1, 0.01);
  EXPECT_NEAR(irradiance(soft, below, up, 2000) / full, 1, 0.01);
  for (const SpotLight* light : {&hard, &soft}) {
    expect_agreement(*light, below);
    expect_agreement(*light, V3f(4 * std::tan(20 * kDegree), 0, 0));
    const V3f outside(4 * std::tan(22 * kDegree), 0, 0), above(0, 8, 0);
    EXPECT_EQ(irradiance(*light, outside, up, 100), 0);
    EXPECT_EQ(light->importance(outside), 0);
    EXPECT_EQ(irradiance(*light, above, -up, 100), 0);
    EXPECT_EQ(light->importance(above), 0);
  }
  // In the middle of the cosines of the soft border, half of the light.
  const double middle = std::acos((std::cos(10 * kDegree) + std::cos(20 * kDegree)) / 2);
  const V3f there(static_cast<float>(4 * std::tan(middle)), 0, 0);
  const double distance2 = 16 + there.length2();
  EXPECT_NEAR(irradiance(soft, there, (V3f(0, 4, 0) - there).normalized(), 4000) * distance2 / (16 * full),
              0.5, 0.01);
  EXPECT_GT(soft.importance(there), 0);
}

/// Left half red, right half black; the upper row is twice as bright.
std::shared_ptr<const Texture> halves() {
  Image image{64, 64, 3, std::vector<float>(size_t{64} * 64 * 3, 0.0f)};
  for (int y = 0; y < 64; ++y)
    for (int x = 0; x < 32; ++x) image.at(x, y)[0] = y < 32 ? 2 : 1;
  return std::make_shared<Texture>(image);
}

TEST(SpotLight, ProjectsItsGoboUpright) {
  // For a viewer who looks along the axis, straight down, +z is up and +x is at the right.
  const SpotLight light = spot(20, 0, halves());
  const V3f up(0, 1, 0);
  const double full = kPi * 1000 * 0.05 * 0.05 / 16 * luminance(Rgb(1, 0, 0));
  EXPECT_NEAR(irradiance(light, V3f(-0.3f, 0, 0.3f), up, 2000) / full, 2, 0.1);
  EXPECT_NEAR(irradiance(light, V3f(-0.3f, 0, -0.3f), up, 2000) / full, 1, 0.05);
  EXPECT_EQ(irradiance(light, V3f(0.3f, 0, 0.3f), up, 100), 0);
}

TEST(RectangleLight, ShowsItsImageFromTheEmittingSide) {
  Rectangle shape;  // shines along +z; a viewer who looks along -z sees +x at the right and +y up
  const RectangleLight light("r", shape, Rgb(1), false, true, {.image = halves()});
  const auto seen = [&](float x, float y) {
    return light.intersect(V3f(x, y, 1), V3f(0, 0, -1))->radiance.x;
  };
  EXPECT_EQ(seen(-0.3f, 0.3f), 2);
  EXPECT_EQ(seen(-0.3f, -0.3f), 1);
  EXPECT_EQ(seen(0.3f, 0.3f), 0);
  EXPECT_NEAR(irradiance(light, V3f(0, 0, 30), V3f(0, 0, -1), 20000) * 900 / luminance(Rgb(1, 0, 0)), 0.75,
              0.02);
  EXPECT_NEAR(light.importance(V3f(0, 0, 30)) * 900 / luminance(Rgb(1, 0, 0)), 0.75, 0.01);
}

/// The triangles of a box around the origin, whose outer sides emit.
std::vector<MeshLight::Triangle> box(const V3f& half) {
  std::vector<MeshLight::Triangle> triangles;
  for (int axis = 0; axis < 3; ++axis) {
    for (const float side : {-1.0f, 1.0f}) {
      V3f n(0), a(0), b(0);
      n[axis] = side * half[axis];
      a[(axis + 1) % 3] = side * half[(axis + 1) % 3];
      b[(axis + 2) % 3] = half[(axis + 2) % 3];
      triangles.push_back({{n - a - b, n + a - b, n + a + b}});
      triangles.push_back({{n - a - b, n + a + b, n - a + b}});
    }
  }
  return triangles;
}

TEST(MeshLight, AgreesAndHidesItsFarSide) {
  std::vector<MeshLight::Triangle> two = box({1, 1, 1});
  for (MeshLight::Triangle t : box({1, 1, 1})) {  // behind the first, seen from +x
    for (V3f& corner : t.corners) corner.x -= 3;
    two.push_back(t);
  }
  const MeshLight light("mesh", two, Rgb(2, 1, 0.5f), true);
  EXPECT_NEAR(light.area(), 48, 1e-4f);
  for (const V3f& from : {V3f(4, 0.3f, 0.2f), V3f(2, 3, 1), V3f(-1.5f, 4, 0.5f), V3f(20, 30, -10)})
    expect_agreement(light, from);
  EXPECT_FALSE(light.intersect(V3f(0), V3f(1, 0, 0))) << "inside, the inner side is black";
  EXPECT_EQ(light.intersect(V3f(4, 0.3f, 0.2f), V3f(-1, 0, 0))->distance, 3);
}

TEST(MeshLight, FacesBackToBackShineBothWays) {
  const MeshLight::Triangle front{{V3f(0), V3f(1, 0, 0), V3f(0, 1, 0)}},
      back{{V3f(0), V3f(0, 1, 0), V3f(1, 0, 0)}};
  for (const bool front_first : {true, false}) {
    const std::vector<MeshLight::Triangle> sheet =
        front_first ? std::vector{front, back} : std::vector{back, front};
    const MeshLight light("mesh", sheet, Rgb(1), true);
    for (const float z : {1.0f, -1.0f}) {
      expect_agreement(light, V3f(0.3f, 0.3f, z));
      EXPECT_TRUE(light.intersect(V3f(0.3f, 0.3f, z), V3f(0, 0, -z)));
    }
  }
}

TEST(MeshLight, AMissingFileIsNamedWhereTheSceneNamesIt) {
  MemoryLedger ledger;
  TextureLibrary textures(ledger);
  MeshLightParams params;
  params.file.path = "missing.obj";
  params.file.position = {"scene.yaml", 7, 12};
  try {
    make_light("tubes", params, 1, textures, ledger);
    FAIL();
  } catch (const Error& error) {
    EXPECT_EQ(to_string(error.problems().front().position), "scene.yaml:7:12");
    EXPECT_NE(error.problems().front().message.find("missing.obj"), std::string::npos);
  }
}

TEST(MeshLight, PassesChiSquareOverDirections) {
  // In a grid around a point beside the mesh: the density is smooth within a side, so that edges only matter
  // in a few cells, whose integral the fine steps find.
  const MeshLight light("mesh", box({1, 1, 1}), Rgb(1), true);
  const V3f from(3, 0.2f, -0.1f);  // sees the side x = 1 only
  TestRandom random(4);
  constexpr int kCells = 24, kSamples = 100000;
  std::vector<double> observed(kCells * kCells + 1), expected(kCells * kCells + 1);
  for (int i = 0; i < kSamples; ++i) {
    const auto s = light.sample(from, random.unit2());
    const V3f at = s ? from + s->distance * s->direction : V3f(0);
    const auto cell = [](float v) {
      return std::clamp(static_cast<int>((v + 1) / 2 * kCells), 0, kCells - 1);
    };
    ++observed[s ? static_cast<size_t>(cell(at.y) * kCells + cell(at.z)) : kCells * kCells];
  }
  for (int i = 0; i < kCells * kCells; ++i) {
    const V3f at(1, 2 * (i / kCells + 0.5f) / kCells - 1, 2 * (i % kCells + 0.5f) / kCells - 1);
    const V3f to = at - from, w = to.normalized();
    expected[i] = kSamples * double{light.pdf(from, w)} * -w.x / to.length2() * 4 / (kCells * kCells);
  }
  expected.back() = kSamples * 5.0 / 6;  // the other sides
  const ChiSquare test = chi_square(observed, expected);
  EXPECT_GT(test.p, 1e-3) << test.statistic << " / " << test.dof;
}

TEST(MeshLight, HasTheIrradianceOfARectangle) {
  const MeshLight light("mesh", box({1, 0.5f, 1}), Rgb(1), true);
  Rectangle side{{1, 0, 0}, {0, 1, 0}, {0, 0, 1}, {0.5f, 1}};
  const RectangleLight rectangle("r", side, Rgb(1), false, true);
  const V3f from(2.5f, 0.2f, 0.3f), normal(-1, 0, 0);
  EXPECT_NEAR(irradiance(light, from, normal, 200000) / irradiance(rectangle, from, normal, 20000), 1, 0.02);
}

}  // namespace
}  // namespace pelage::light_kinds_test
