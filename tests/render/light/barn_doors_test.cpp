// SPDX-License-Identifier: Apache-2.0
#include "render/light/barn_doors.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>
#include <vector>

#include <gtest/gtest.h>

#include "render/light/rectangle_light.h"
#include "tests/render/light/light_checks.h"
#include "tests/support/chi_square.h"

namespace pelage::barn_doors_test {
namespace {

constexpr double kPiD = std::numbers::pi;

TEST(BarnDoors, BlockTheRaysThatMeetAFlap) {
  // Against flaps as segments in the plane across their hinge.
  BarnDoors doors;
  doors.length = 0.8f;
  doors.left = -20, doors.right = 10, doors.top = 70, doors.bottom = 0;
  const V2f half(0.5f, 1);
  const auto meets = [&](double start, double slope, double hinge, double degrees, double outwards) {
    for (int i = 0; i <= 4000; ++i) {  // points of the flap: does the ray change sides between two of them?
      const double along = doors.length * i / 4000.0, angle = degrees * kPiD / 180;
      const double height = along * std::cos(angle), flap = hinge + outwards * along * std::sin(angle);
      if ((start + slope * height - flap) * outwards > 0) return true;
    }
    return false;
  };
  TestRandom random(9);
  int passed = 0;
  for (int i = 0; i < 400; ++i) {
    const V2f place(random.between(-0.5f, 0.5f), random.between(-1, 1));
    V3f out = random.direction();
    out.z = std::abs(out.z);
    const double x = double{out.x} / out.z, y = double{out.y} / out.z;
    const bool blocked = meets(place.x, x, 0.5, 10, 1) || meets(place.x, x, -0.5, -20, -1) ||
                         meets(place.y, y, 1, 70, 1) || meets(place.y, y, -1, 0, -1);
    EXPECT_EQ(doors.pass(place, half, out), !blocked) << i;
    passed += !blocked;
  }
  EXPECT_GT(passed, 60);
  EXPECT_LT(passed, 340);
  EXPECT_TRUE(BarnDoors().pass({0.5f, 1}, half, V3f(0.9f, 0, 0.1f))) << "without a length, there are none";
}

/// Whether any of many rays passes the doors within a slope.
bool is_open(const BarnDoors& doors, const V2f& half, float max_slope) {
  constexpr int kSlopes = 720, kPlaces = 81;
  // Rays are found along x and y alone, and the least slopes combined.
  float least[2];
  for (int axis = 0; axis < 2; ++axis) {
    least[axis] = std::numeric_limits<float>::infinity();
    for (int i = 0; i < kPlaces * kSlopes; ++i) {
      const float t = 2 * static_cast<float>(i % kPlaces) / (kPlaces - 1) - 1;
      const double degrees = (i / kPlaces + 0.5) * 180 / kSlopes - 90;
      const auto slope = static_cast<float>(std::tan(degrees * kPiD / 180));
      BarnDoors along = doors;  // the doors across the other axis are open
      (axis == 0 ? along.top : along.right) = 89, (axis == 0 ? along.bottom : along.left) = 89;
      V2f place(0);
      V3f direction(0, 0, 1);
      place[axis] = t * half[axis];
      direction[axis] = slope;
      if (along.pass(place, half, direction)) least[axis] = std::min(least[axis], std::abs(slope));
    }
  }
  return std::hypot(least[0], least[1]) < max_slope;
}

TEST(BarnDoors, AreClosedIfNoRayPasses) {
  TestRandom random(4);
  constexpr float kInfinity = std::numeric_limits<float>::infinity();
  int open = 0, closed = 0, by_grid = 0;
  for (int i = 0; i < 40; ++i) {
    BarnDoors doors;
    doors.length = random.between(0.2f, 1);
    for (float* angle : {&doors.left, &doors.right, &doors.top, &doors.bottom})
      *angle = random.between(-60, 20);
    const V2f half(random.between(0.1f, 0.4f), random.between(0.1f, 0.4f));
    BarnDoors narrower = doors;  // if these pass light, those have no slit that the search could miss
    for (float* angle : {&narrower.left, &narrower.right, &narrower.top, &narrower.bottom}) *angle -= 2;
    for (const float max_slope : {kInfinity, 0.3f}) {
      if (doors.are_closed(half, max_slope)) {
        ++(max_slope < 1 ? by_grid : closed);
        EXPECT_FALSE(is_open(doors, half, max_slope)) << i;
      } else if (!narrower.are_closed(half, max_slope)) {
        ++open;
        EXPECT_TRUE(is_open(doors, half, max_slope)) << i;
      }
    }
  }
  EXPECT_GT(open, 10);
  EXPECT_GT(closed, 10);
  EXPECT_GT(by_grid, closed);
  EXPECT_FALSE(BarnDoors().are_closed(V2f(1), kInfinity));
}

RectangleLight shaped(bool two_sided = false) {
  BarnDoors doors;
  doors.length = 0.4f;
  doors.left = 60, doors.right = 5, doors.top = 20, doors.bottom = 20;
  return {"r", Rectangle{}, Rgb(2, 1, 0.5f), two_sided, true, {.grid = SpreadGrid(120), .doors = doors}};
}

TEST(BarnDoors, SamplesAndRaysAgree) {
  // Shines along +z; seen from there, +x is the right side.
  for (const V3f& from : {V3f(0, 0, 2), V3f(-1, 0.2f, 1.2f), V3f(0.1f, 0.3f, 0.2f)}) {
    expect_agreement(shaped(), from);
    expect_agreement(shaped(true), V3f(from.x, from.y, -from.z));
  }
  EXPECT_FALSE(shaped().intersect(V3f(1.5f, 0, 0.6f), V3f(-1.5f, 0, -0.6f).normalized())) << "right flap";
  EXPECT_TRUE(shaped().intersect(V3f(-1, 0, 1), V3f(1, 0, -1).normalized())) << "left flap is open";
}

TEST(BarnDoors, PassChiSquareOverTheRectangle) {
  const RectangleLight light = shaped();
  const V3f from(1.1f, 0.3f, 0.9f);
  TestRandom random(4);
  constexpr int kCells = 12, kSteps = 16, kSamples = 60000;
  std::vector<double> observed(kCells * kCells + 1), expected(kCells * kCells + 1);
  const auto cell = [](float v) { return std::clamp(static_cast<int>((v + 0.5f) * kCells), 0, kCells - 1); };
  for (int i = 0; i < kSamples; ++i) {
    const auto s = light.sample(from, random.unit2());
    const V3f at = s ? from + s->distance * s->direction : V3f(0);
    ++observed[s ? static_cast<size_t>(cell(at.x) * kCells + cell(at.y)) : kCells * kCells];
  }
  double inside = 0;
  constexpr int kFine = kCells * kSteps;
  for (int i = 0; i < kFine * kFine; ++i) {
    const V3f at((i / kFine + 0.5f) / kFine - 0.5f, (i % kFine + 0.5f) / kFine - 0.5f, 0), to = at - from;
    const V3f w = to.normalized();
    const double mass = double{light.pdf(from, w)} * -w.z / to.length2() / (double{kFine} * kFine);
    expected[static_cast<size_t>(cell(at.x) * kCells + cell(at.y))] += kSamples * mass;
    inside += mass;
  }
  EXPECT_LT(inside, 0.9) << "the flaps block something";
  EXPECT_NEAR(observed.back() / (kSamples * (1 - inside)), 1, 0.03) << "samples that the flaps block";
  // Edges of flaps cross cells, where the sum over 16 x 16 places is off by up to 1/16 of a cell: compares
  // only the cells that are lit as a whole or not at all.
  std::vector<double> observed_whole, expected_whole;
  for (size_t i = 0; i + 1 < expected.size(); ++i) {
    const V3f at((static_cast<float>(i / kCells) + 0.5f) / kCells - 0.5f,
                 (static_cast<float>(i % kCells) + 0.5f) / kCells - 0.5f, 0);
    const V3f to = at - from;
    const double full = kSamples * double{light.pdf(from, to.normalized())} * from.z /
                        std::pow(to.length(), 3) / (kCells * kCells);
    if (std::abs(expected[i] - full) > 0.03 * full) continue;
    if (full == 0) {
      EXPECT_LT(observed[i], kSamples / 8.0 / (kCells * kCells)) << "light may touch the edge of cell " << i;
      continue;
    }
    observed_whole.push_back(observed[i]);
    expected_whole.push_back(expected[i]);
  }
  const ChiSquare test = chi_square(observed_whole, expected_whole);
  EXPECT_GT(test.p, 1e-3) << test.statistic << " / " << test.dof;
  EXPECT_GT(test.dof, 60);
}

TEST(BarnDoors, LightSamplingHasTheMeanOfRays) {
  const RectangleLight light = shaped();
  const V3f from(0.8f, 0.1f, 0.7f), normal(0, 0, -1);
  TestRandom random(12);
  double sum = 0;
  constexpr int kRays = 200000;
  for (int i = 0; i < kRays; ++i) {
    V3f w = random.direction();
    w.z = -std::abs(w.z);
    if (const auto hit = light.intersect(from, w)) sum += luminance(hit->radiance) * -w.z * 2 * kPiD / kRays;
  }
  // The rays' mean has an error of 0.6 %, as 14 % of them hit.
  EXPECT_NEAR(irradiance(light, from, normal, 100000) / sum, 1, 0.02);
}

}  // namespace
}  // namespace pelage::barn_doors_test
