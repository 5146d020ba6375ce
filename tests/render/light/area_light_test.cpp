// SPDX-License-Identifier: Apache-2.0
#include <gtest/gtest.h>

#include "render/light/rectangle_light.h"
#include "render/light/sphere_light.h"
#include "render/light/spherical_rectangle.h"
#include "tests/render/random.h"
#include "tests/render/sphere_statistics.h"

namespace pelage::area_light_test {
namespace {

constexpr double kPiD = std::numbers::pi;

TEST(SphericalRectangle, HasTheReferenceNumbers) {
  // Computed in double precision from the formulas of [Urena13].
  const SphericalRectangle centred(0, 0, -1, 0.5, 0.5);
  EXPECT_NEAR(centred.solid_angle(), 0.80543168, 1e-8);
  EXPECT_NEAR(centred.solid_angle(), 4 * std::asin(0.2), 1e-12);
  const V3d p = centred.sample(0.3, 0.7);
  EXPECT_NEAR(p.x, -0.18288937, 1e-8);
  EXPECT_NEAR(p.y, 0.18233100, 1e-8);
  const SphericalRectangle offset(1.2, 0.4, -0.5, 1, 0.5);
  EXPECT_NEAR(offset.solid_angle(), 0.80947398, 1e-8);
  const V3d q = offset.sample(0.25, 0.5);
  EXPECT_NEAR(q.x, 0.32661692, 1e-8);
  EXPECT_NEAR(q.y, 0.21165925, 1e-8);
  EXPECT_NEAR(SphericalRectangle(0, 0, -0.5, 1, 0.5).solid_angle(), 2.73887681, 1e-8);
  // Irradiance: the mean cosine of uniform directions times the solid angle.
  double cosine = 0;
  constexpr int kSteps = 400;
  for (int i = 0; i < kSteps * kSteps; ++i) {
    const V3d w = offset.sample((i % kSteps + 0.5) / kSteps, (i / kSteps + 0.5) / kSteps);
    cosine += std::abs(w.z) / w.length() / (kSteps * kSteps);
  }
  EXPECT_NEAR(cosine * offset.solid_angle(), 0.48744, 5e-6);
}

TEST(SphericalRectangle, SolidAngleIsTheIntegralOverItsArea) {
  TestRandom random(3);
  for (int i = 0; i < 60; ++i) {
    const double z = std::pow(10.0, random.between(-1, 3));
    const double x = z * random.between(-3, 3), y = z * random.between(-3, 3);
    const double a = random.between(0.01f, 1), b = random.between(0.01f, 1);
    double sum = 0;
    constexpr int kSteps = 300;
    for (int k = 0; k < kSteps * kSteps; ++k) {
      const double px = x + a * (2 * (k % kSteps + 0.5) / kSteps - 1),
                   py = y + b * (2 * (k / kSteps + 0.5) / kSteps - 1);
      const double d2 = px * px + py * py + z * z;
      sum += z / (d2 * std::sqrt(d2));
    }
    sum *= 4 * a * b / (kSteps * kSteps);
    EXPECT_NEAR(SphericalRectangle(x, y, z, a, b).solid_angle() / sum, 1, 2e-3) << x << " " << y << " " << z;
    // Both branches give points of the rectangle with the density that they state.
    const SphericalRectangle seen(x, y, z, a, b);
    for (int k = 0; k < 20; ++k) {
      const V3d p = seen.sample(random.unit(), random.unit());
      ASSERT_LE(std::abs(p.x - x), a * (1 + 1e-12));
      ASSERT_LE(std::abs(p.y - y), b * (1 + 1e-12));
      ASSERT_EQ(p.z, z);
      ASSERT_NEAR(seen.pdf(p.length()) * sum, 1, sum < 1e-6 ? 10 * std::max(a, b) / z + 2e-3 : 2e-3);
    }
  }
}

TEST(SphericalRectangle, InItsOwnPlaneItIsNotThere) {
  EXPECT_EQ(SphericalRectangle(3, 0, 0, 1, 1).solid_angle(), 0);
  EXPECT_EQ(SphericalRectangle(0, 0, 0, 1, 1).solid_angle(), 0);
  EXPECT_NEAR(SphericalRectangle(0, 0, 1e-9, 1, 1).solid_angle(), 2 * kPiD, 1e-6);
  EXPECT_EQ(SphericalRectangle(3, 0, 0, 1, 1).pdf(3), 0);
}

const V3f kCenter(1, 2, -1);

/// Turned out of the axes.
Rectangle tilted_rectangle() {
  Rectangle shape;
  shape.center = kCenter;
  shape.x = V3f(0.6f, 0, 0.8f);
  shape.half_size = {1.5f, 0.5f};
  return shape;
}

struct LightCase {
  std::string name;
  std::shared_ptr<const Light> light;
  V3f from;
  double solid_angle;  ///< an independent figure; negative: none
};

std::vector<LightCase> rectangle_grid() {
  const Rectangle shape = tilted_rectangle();
  const V3f normal = shape.x.cross(shape.y);
  const auto rectangle = [&](bool two_sided) {
    return std::make_shared<RectangleLight>("rectangle", shape, Rgb(2, 1, 0.5f), two_sided, true);
  };
  const double d = 2, a = 3, b = 1;
  const double centred = 4 * std::asin(a * b / std::sqrt((a * a + 4 * d * d) * (b * b + 4 * d * d)));
  return {{"rectangle ahead", rectangle(false), kCenter + 2.0f * normal, centred},
          {"rectangle aside", rectangle(false), kCenter + 0.7f * normal + 2.0f * shape.x, -1},
          {"rectangle near", rectangle(false), kCenter + 0.1f * normal + 0.3f * shape.y, -1},
          {"rectangle grazing", rectangle(false), kCenter + 0.05f * normal + 2.5f * shape.x, -1},
          {"rectangle behind, two-sided", rectangle(true), kCenter - 2.0f * normal, centred}};
}

std::vector<LightCase> sphere_grid() {
  const auto light = std::make_shared<SphereLight>("sphere", kCenter, 1.0f, Rgb(2, 1, 0.5f), true);
  return {{"sphere", light, {1, 2, 1}, 0.84178721},
          {"sphere near", light, {1, 2, 0.01f}, -1},
          {"sphere far", light, {1, 12, -1}, 2 * kPiD * (1 - std::sqrt(0.99))},
          {"sphere from inside", light, {1.5f, 2, -1.2f}, 4 * kPiD},
          {"sphere from its centre", light, kCenter, 4 * kPiD}};
}

std::vector<LightCase> light_grid() {
  std::vector<LightCase> grid = rectangle_grid();
  for (LightCase& c : sphere_grid()) grid.push_back(c);
  return grid;
}

TEST(AreaLight, RectanglesPassChiSquare) {
  // In cells of the rectangle, where the density per area is smooth: pdf cos / distance^2.
  const std::vector<LightCase> grid = rectangle_grid();
  const double level = sidak_level(1e-3, grid.size());
  const Rectangle shape = tilted_rectangle();
  const V3f normal = shape.x.cross(shape.y);
  for (const LightCase& c : grid) {
    constexpr int kCells = 40, kSteps = 12, kSamples = 200000;
    std::vector<double> observed(kCells * kCells, 0.0), expected(kCells * kCells, 0.0);
    TestRandom random(21);
    for (int i = 0; i < kSamples; ++i) {
      const std::optional<LightSample> s = c.light->sample(c.from, random.unit2());
      ASSERT_TRUE(s) << c.name;
      const V3f on_plane = c.from + s->distance * s->direction - kCenter;
      ASSERT_NEAR(on_plane.dot(normal), 0, 1e-5) << c.name;
      const auto cell = [](float place) {
        return std::clamp(static_cast<int>((place + 1) / 2 * kCells), 0, kCells - 1);
      };
      const float x = on_plane.dot(shape.x) / shape.half_size.x,
                  y = on_plane.dot(shape.y) / shape.half_size.y;
      ASSERT_LE(std::max(std::abs(x), std::abs(y)), 1.0f + 1e-5f) << c.name;
      observed[cell(y) * kCells + cell(x)] += 1;
    }
    double integral = 0;
    const double area = 3.0 * 1.0 / (kCells * kSteps * kCells * kSteps);
    for (int j = 0; j < kCells * kSteps; ++j) {
      for (int i = 0; i < kCells * kSteps; ++i) {
        const float x = 2 * (i + 0.5f) / (kCells * kSteps) - 1, y = 2 * (j + 0.5f) / (kCells * kSteps) - 1;
        const V3f to = kCenter + x * shape.half_size.x * shape.x + y * shape.half_size.y * shape.y - c.from;
        const double distance = to.length();
        const V3f direction = to.normalized();
        const double mass =
            c.light->pdf(c.from, direction) * std::abs(direction.dot(normal)) / (distance * distance) * area;
        expected[(j / kSteps) * kCells + i / kSteps] += kSamples * mass;
        integral += mass;
      }
    }
    EXPECT_NEAR(integral, 1, 1e-3) << c.name;
    const ChiSquare test = chi_square(observed, expected);
    EXPECT_GT(test.p, level) << c.name << ": " << test.statistic << " / " << test.dof;
  }
}

TEST(AreaLight, SpheresPassChiSquare) {
  const std::vector<LightCase> grid = sphere_grid();
  const double level = sidak_level(1e-3, grid.size());
  for (const LightCase& c : grid) {
    TestRandom random(22);
    const V3f to_center = kCenter - c.from;
    const float distance = to_center.length();
    SphereTestSize size;
    if (distance > 1) size.z_low = std::sqrt(1 - 1 / (static_cast<double>(distance) * distance));
    const SphereGrid sphere(distance > 0 ? to_center.normalized() : V3f(0, 0, 1));
    const ChiSquare test = sphere_chi_square(
        sphere,
        [&](int) -> std::optional<V3f> {
          const std::optional<LightSample> s = c.light->sample(c.from, random.unit2());
          return s ? std::optional<V3f>(s->direction) : std::nullopt;
        },
        [&](const V3f& w) { return c.light->pdf(c.from, w); }, size);
    EXPECT_GT(test.p, level) << c.name << ": " << test.statistic << " / " << test.dof;
    EXPECT_LE(test.impossible, 2) << c.name << ": rounding over the edge of the cap";
  }
}

TEST(AreaLight, SampleIntersectAndPdfTellTheSame) {
  for (const LightCase& c : light_grid()) {
    TestRandom random(5);
    int edge = 0;
    for (int i = 0; i < 5000; ++i) {
      const std::optional<LightSample> s = c.light->sample(c.from, random.unit2());
      ASSERT_TRUE(s) << c.name;
      ASSERT_NEAR(s->direction.length(), 1, 1e-5f);
      ASSERT_EQ(s->radiance, Rgb(2, 1, 0.5f));
      const std::optional<LightHit> hit = c.light->intersect(c.from, s->direction);
      if (!hit) {
        ++edge;
        continue;
      }
      ASSERT_EQ(hit->radiance, s->radiance);
      ASSERT_NEAR(hit->distance, s->distance, 2e-3f * std::max(1.0f, s->distance)) << c.name;
      ASSERT_NEAR(c.light->pdf(c.from, s->direction) / s->pdf, 1, 1e-4f) << c.name;
      if (c.solid_angle > 0) {
        ASSERT_NEAR(s->pdf * c.solid_angle, 1, 1e-5) << c.name;
      }
    }
    EXPECT_LE(edge, 5) << c.name << ": directions that rounding carried over the edge";
  }
}

TEST(AreaLight, PdfIsZeroWhereRaysMiss) {
  for (const LightCase& c : light_grid()) {
    TestRandom random(6);
    for (int i = 0; i < 2000; ++i) {
      const V3f w = random.direction();
      ASSERT_EQ(c.light->pdf(c.from, w) > 0, c.light->intersect(c.from, w).has_value()) << c.name;
    }
  }
}

TEST(AreaLight, SmallAndFarOnesKeepTheirPower) {
  // Irradiance at normal incidence is area / distance^2 for all of these.
  const V3f from(0);
  for (float distance : {10.0f, 100.0f, 1000.0f, 10000.0f}) {
    Rectangle shape;
    shape.center = {0, 0, distance};
    shape.x = V3f(-1, 0, 0);
    shape.half_size = {0.5f, 0.25f};
    const RectangleLight rectangle("r", shape, Rgb(1), false, true);
    const SphereLight sphere("s", shape.center, 0.5f, Rgb(1), true);
    TestRandom random(9);
    double r = 0, s = 0;
    for (int i = 0; i < 1000; ++i) {
      const V2f u = random.unit2();
      const std::optional<LightSample> a = rectangle.sample(from, u), b = sphere.sample(from, u);
      ASSERT_TRUE(a && b);
      ASSERT_TRUE(rectangle.intersect(from, a->direction) || u.x < 0.01f || u.y < 0.01f || u.x > 0.99f ||
                  u.y > 0.99f);
      r += a->direction.z / a->pdf / 1000;
      s += b->direction.z / b->pdf / 1000;
    }
    EXPECT_NEAR(r * distance * distance / 0.5, 1, 5e-3) << distance;
    EXPECT_NEAR(s * distance * distance / (kPiD * 0.25), 1, 5e-3) << distance;
    EXPECT_NEAR(rectangle.importance(from) * distance * distance / 0.5, 1, 5e-3) << distance;
  }
}

TEST(AreaLight, RectanglesShineToTheirSideOnly) {
  Rectangle shape;  // shines along +z
  const RectangleLight one("r", shape, Rgb(1), false, true), two("r", shape, Rgb(1), true, true);
  const V3f behind(0.1f, 0.2f, -1), ahead(0.1f, 0.2f, 1), beside(2, 0, 0), back(0, 0, 1);
  EXPECT_FALSE(one.sample(behind, V2f(0.5f)));
  EXPECT_FALSE(one.intersect(behind, back));
  EXPECT_EQ(one.importance(behind), 0);
  EXPECT_EQ(one.pdf(behind, back), 0);
  EXPECT_TRUE(one.sample(ahead, V2f(0.5f)));
  EXPECT_TRUE(one.intersect(ahead, -back));
  EXPECT_FALSE(one.intersect(ahead, back));
  EXPECT_TRUE(two.sample(behind, V2f(0.5f)));
  EXPECT_TRUE(two.intersect(behind, back));
  EXPECT_GT(two.importance(behind), 0);
  for (const RectangleLight* light : {&one, &two}) {
    EXPECT_FALSE(light->sample(beside, V2f(0.5f)));
    EXPECT_EQ(light->importance(beside), 0);
    EXPECT_FALSE(light->intersect(beside, V3f(-1, 0, 0)));
  }
}

}  // namespace
}  // namespace pelage::area_light_test
