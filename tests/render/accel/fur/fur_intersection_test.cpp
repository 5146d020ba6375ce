// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <cmath>
#include <limits>

#include <gtest/gtest.h>

#include "geom/curve.h"
#include "render/accel/flush_denormals.h"
#include "tests/render/accel/fur/fur_grooms.h"
#include "tests/render/accel/fur/fur_truth.h"
#include "tests/soak.h"
#include "tests/support/effort.h"

namespace pelage::fur_intersection_test {
namespace {

constexpr size_t kStrands = 30;

class FurIntersection : public testing::TestWithParam<GroomShape> {};

/// Whether the truth finds the same segment first, or nothing as well, somewhere within `margin` sideways of
/// the ray, or where the ray begins and ends that much sooner or later: then the ray passes an edge that
/// near. What was hit must be a hit of a ray that near, too, and as deep as the truth finds it around there.
/// (Of a ray that runs along a strand, how deep it meets it depends on the square root of how far it passes
/// from where it would not meet it: rays within the margin meet it at depths that differ by far more than
/// that.)
bool agrees_near_edge(const FurTruth& truth, const FurHit& hit, double margin) {
  // Near, too: beside the axis, the gap that corners of polylines have on their outside is a hair's breadth.
  constexpr int kAngles = 16, kRadii = 12;
  bool same = false;
  double nearest = std::numeric_limits<double>::infinity(), farthest = 0;
  const auto look = [&](double x, double y, double z) {
    const FurTruth::Found found = truth.closest(x, y, z);
    if (found.number != hit.number) return;
    same = true;
    nearest = std::min(nearest, found.distance);
    farthest = std::max(farthest, found.distance);
  };
  for (int i = 0; i <= kRadii * kAngles; ++i) {
    const double angle = 2 * std::numbers::pi * (i % kAngles) / kAngles;
    const double r = i == kRadii * kAngles ? 0 : std::ldexp(margin, -(i / kAngles));
    for (const double z : {0.0, margin, -margin}) look(r * std::cos(angle), r * std::sin(angle), z);
  }
  if (!hit) return same;
  const FurTruth::Place place = truth.place_at(hit.number, hit.u);
  look(place.x, place.y, 0);
  return same && place.moved <= margin && place.beside <= margin &&
         std::abs(place.distance - hit.distance) <= margin && hit.distance >= nearest - 4 * margin &&
         hit.distance <= farthest + 4 * margin;
}

/// The distance of neighbouring floats at the largest coordinate of where the ray begins and where it meets
/// something. Trees count coordinates from the anchor of their grid.
float float_step(const Ray& ray, double distance, const V3f& anchor) {
  const V3d from = V3d(ray.origin) - V3d(anchor);
  const V3d to = from + (std::isfinite(distance) ? distance : 0) * V3d(ray.direction);
  double max = 0;
  for (int i = 0; i < 3; ++i) max = std::max({max, std::abs(from[i]), std::abs(to[i])});
  const auto coordinate = static_cast<float>(max);
  return std::nextafter(coordinate, std::numeric_limits<float>::infinity()) - coordinate;
}

TEST_P(FurIntersection, is_that_of_ribbons_in_double_precision) {
  const FlushDenormals flush;
  const GroomShape& shape = GetParam();
  const Strands strands = random_groom(shape, kStrands, 1);
  const SnappedStrands snapped(strands, FurGrid(shape.width, shape.centre));
  const FurTree tree(snapped, {});
  TestRandom random(2);
  const uint64_t begin = soak_begin(), rays = begin + repetitions(1500) * soak_scale();
  uint64_t hits = 0, edges = 0;
  for (uint64_t i = 0; i < rays; ++i) {
    const Ray ray = ray_at_groom(shape, strands, random, i);
    if (i < begin) continue;
    const FurTruth truth(snapped, ray);
    const FurTruth::Found expected = truth.closest();
    const FurHit hit = tree.closest(ray, {});
    ASSERT_EQ(bool(hit), tree.occluded(ray, {})) << i;
    hits += bool(hit);
    const float step = float_step(ray, hit ? hit.distance : expected.distance, shape.centre);
    const double margin = std::max(1e-3f * shape.width, step);
    if (hit.number == expected.number && (!hit || std::abs(hit.distance - expected.distance) < 4 * margin))
      continue;
    ++edges;
    EXPECT_TRUE(agrees_near_edge(truth, hit, margin))
        << "ray " << i << ": " << hit.number << " at " << hit.distance << ", truth " << expected.number
        << " at " << expected.distance;
  }
  EXPECT_GT(hits, (rays - begin) / 100);
  EXPECT_LT(edges, hits / 10 + 3);
}

INSTANTIATE_TEST_SUITE_P(grooms, FurIntersection, testing::ValuesIn(groom_shapes_at_any_distance()),
                         [](const auto& of) {
                           std::string name = of.param.name;
                           std::replace(name.begin(), name.end(), ' ', '_');
                           return name;
                         });

Ray towards_z(float x, float y) {
  Ray ray;
  ray.origin = {x, y, -1};
  return ray;
}

// A curve that runs along the ray at last, having come from far beside it: the root that says where it is
// nearest is all but fivefold, and far from it Newton's steps are short.
TEST(FurHit, is_found_where_curves_come_to_rest_beside_the_ray) {
  const FlushDenormals flush;
  constexpr float kWidth = 1e-3f;
  TestRandom random(8);
  int hits = 0;
  for (int i = 0; i < 4000; ++i) {
    const auto near_ray = [&](float z) {
      return V3f(0.02f * kWidth * random.between(-1, 1), 0.02f * kWidth * random.between(-1, 1), z);
    };
    StrandArrays a;
    a.basis = CurveBasis::kBezier;
    a.first_point = {0, 4};
    a.ids = {5};
    const float beside = std::pow(10.0f, random.between(-3, 0));
    for (const V3f& p : {V3f(beside, 0, 1), near_ray(1.1f), near_ray(1.2f), near_ray(1.3f)})
      a.points.insert(a.points.end(), {p.x, p.y, p.z, 0.5f * kWidth});
    const Strands strands(std::move(a));
    const SnappedStrands snapped(strands, FurGrid(kWidth));
    const FurTree tree(snapped, {});
    const Ray ray = towards_z(0, 0.1f * kWidth);
    const FurHit hit = tree.closest(ray, {});
    if (!hit) continue;
    ++hits;
    const FurTruth truth(snapped, ray);
    // Where a curve turns round, it has no direction in which the ray could have passed elsewhere.
    if (std::abs(hit.distance - truth.closest().distance) < 4e-3f * kWidth) continue;
    EXPECT_LT(truth.place_at(0, hit.u).moved, 1e-3f * kWidth) << i << ": " << hit.u;
  }
  EXPECT_GT(hits, 1000);
}

/// One straight strand along x from 0 to 7, half a unit wide.
Strands straight() {
  StrandArrays a;
  a.first_point = {0, 8};
  a.ids = {5};
  for (int i = 0; i < 8; ++i) a.points.insert(a.points.end(), {static_cast<float>(i), 0, 0, 0.25f});
  return Strands(std::move(a));
}

TEST(FurHit, says_where_on_the_ribbon) {
  const Strands strands = straight();
  const SnappedStrands snapped(strands, FurGrid(0.5f));
  const FurTree tree(snapped, {});
  const FurHit hit = tree.closest(towards_z(2.25f, 0.125f), {});
  ASSERT_TRUE(hit);
  EXPECT_EQ(hit.number, 2u);
  EXPECT_NEAR(hit.distance, 1, 1e-5);
  EXPECT_NEAR(hit.u, 0.25f, 1e-3);
  // T = x, the ray runs along z: ez = T x -direction = y; the hit lies at axis - h r ez.
  EXPECT_NEAR(hit.h, -0.5f, 1e-2);
  EXPECT_FALSE(tree.closest(towards_z(2.25f, 0.26f), {}));
  EXPECT_FALSE(tree.closest(towards_z(-0.1f, 0), {}));
}

TEST(FurHit, is_not_beyond_an_end_where_points_coincide) {
  StrandArrays a = straight().release();
  // Files may repeat points: segments then end in, or are, a single point.
  for (int i = 5; i < 8; ++i) a.points[static_cast<size_t>(i) * 4] = 5;
  for (CurveBasis basis : {CurveBasis::kPinnedBSpline, CurveBasis::kLinear}) {
    StrandArrays of_basis = a;
    of_basis.basis = basis;
    const Strands strands(std::move(of_basis));
    const SnappedStrands snapped(strands, FurGrid(0.5f));
    const FurTree tree(snapped, {});
    for (const float side : {-0.1f, 0.0f, 0.1f}) {
      EXPECT_TRUE(tree.occluded(towards_z(4.9f, side), {}));
      EXPECT_FALSE(tree.occluded(towards_z(5.1f, side), {}));
      EXPECT_FALSE(tree.occluded(towards_z(-0.1f, side), {}));
      // Through a joint, and through its very middle.
      EXPECT_TRUE(tree.occluded(towards_z(3, side), {}));
    }
  }
}

// Segments are cut off across their direction: where the directions of neighbours differ by the grid's
// rounding, rays on the outside of the bend would pass between them.
TEST(FurHit, leaves_no_gap_at_the_joints_of_smooth_strands) {
  for (const CurveBasis basis : {CurveBasis::kPinnedBSpline, CurveBasis::kBSpline, CurveBasis::kCatmullRom}) {
    for (const int keys : {1, 3}) {
      GroomShape shape = groom_shapes()[0];
      shape.basis = basis;
      shape.motion_keys = keys;
      const Strands strands = random_groom(shape, 100, 5);
      const SnappedStrands snapped(strands, FurGrid(shape.width));
      const FurTree tree(snapped, {});
      TestRandom random(6);
      int joints = 0;
      for (uint32_t s = 0; s < strands.strand_count(); ++s) {
        for (uint32_t k = 1; k < segment_count(basis, strands.strand_points(s)); ++k) {
          const float time = random.unit();
          const CubicSegment at = bezier_segment_at(strands, s, k, time);
          const V3f along = (at.p[1] - at.p[0]).normalized();
          const V3f bend = at.p[2] - at.p[0];
          const V3f direction = along.cross(random.direction()).normalized();
          V3f side = along.cross(direction);
          if (side.dot(bend) > 0) side = -1.0f * side;
          for (int i = 0; i < 200; ++i) {
            const float beside = 0.85f * random.unit() * at.r[0];
            Ray ray;
            ray.direction = direction;
            ray.origin = at.p[0] + beside * side + (0.02f * random.between(-1, 1) * at.r[0]) * along -
                         (4 * at.r[0]) * direction;
            ray.far = 8 * at.r[0];
            ray.time = time;
            ASSERT_TRUE(tree.occluded(ray, {})) << "strand " << s << ", joint " << k << ", " << beside;
          }
          ++joints;
        }
      }
      EXPECT_GT(joints, 300);
    }
  }
}

TEST(FurHit, lies_between_near_and_far) {
  const Strands strands = straight();
  const SnappedStrands snapped(strands, FurGrid(0.5f));
  const FurTree tree(snapped, {});
  Ray ray = towards_z(3.5f, 0);
  ray.far = 0.99f;
  EXPECT_FALSE(tree.occluded(ray, {}));
  ray.far = 1.01f;
  EXPECT_TRUE(tree.occluded(ray, {}));
  ray.near = 1.005f;
  EXPECT_FALSE(tree.occluded(ray, {}));
}

TEST(FurHit, is_not_the_strand_that_the_ray_starts_on) {
  const Strands strands = straight();
  const SnappedStrands snapped(strands, FurGrid(0.5f));
  const FurTree tree(snapped, {});
  Ray ray = towards_z(3.5f, 0.1f);
  ray.origin.z = -0.2f;
  EXPECT_TRUE(tree.closest(ray, {}));
  FurStart start{snapped.first_segment(0), 7, 3.5f};
  EXPECT_FALSE(tree.closest(ray, start));
  EXPECT_FALSE(tree.occluded(ray, start));
  start.place = 6;  // 2.5 units along the strand from there: more than two widths
  EXPECT_TRUE(tree.closest(ray, start));
  start.place = 3.5f;
  ray.origin.z = -1.1f;  // farther than two widths along the ray
  EXPECT_TRUE(tree.closest(ray, start));
  start.first_segment = 100;  // another strand
  ray.origin.z = -0.2f;
  EXPECT_TRUE(tree.closest(ray, start));
}

TEST(FurHit, is_asked_of_a_filter) {
  struct Refuse final : FurFilter {
    bool accepts(const FurHit& hit) override {
      EXPECT_NEAR(hit.distance, hit.number == 3 ? 1 : 2, 0.3);
      ++asked;
      return hit.number != 3;
    }
    int asked = 0;
  };
  StrandArrays a = straight().release();
  for (int i = 0; i < 8; ++i) a.points.insert(a.points.end(), {static_cast<float>(i), 0, 1, 0.25f});
  a.first_point.push_back(16);
  a.ids.push_back(9);
  const Strands strands(std::move(a));
  const SnappedStrands snapped(strands, FurGrid(0.5f));
  const FurTree tree(snapped, {});
  Refuse filter;
  EXPECT_EQ(tree.closest(towards_z(3.5f, 0), {}, &filter).number, 10u);
  EXPECT_EQ(tree.closest(towards_z(3.5f, 0), {}).number, 3u);
  EXPECT_TRUE(tree.occluded(towards_z(3.5f, 0), {}, &filter));
  EXPECT_GE(filter.asked, 2);
  Ray ray = towards_z(3.5f, 0);
  ray.far = 1.5f;
  EXPECT_FALSE(tree.occluded(ray, {}, &filter));
}

TEST(FurHit, meets_nothing_of_what_is_not_finite) {
  const float nan = std::numeric_limits<float>::quiet_NaN(), inf = std::numeric_limits<float>::infinity();
  StrandArrays a = random_groom(groom_shapes()[0], 40, 3).release();
  const float odd[] = {nan, inf, -inf, 1e38f, -3e30f, 1e20f, 1e-42f};
  for (size_t i = 0; i < a.points.size(); i += 37) a.points[i] = odd[i % std::size(odd)];
  const Strands strands(std::move(a));
  for (float width : {0.02f, 0.0f, nan, inf, 1e-30f, 1e30f, -1.0f}) {
    const SnappedStrands snapped(strands, FurGrid(width));
    const FurTree tree(snapped, {});
    TestRandom random(4);
    for (uint64_t i = 0; i < 400; ++i) {
      Ray ray = ray_at_groom(groom_shapes()[0], strands, random, 2 + 8 * i);
      ray.far = inf;
      float* numbers[] = {&ray.origin.x, &ray.direction.y, &ray.near, &ray.far, &ray.time, &ray.direction.z};
      *numbers[i % std::size(numbers)] = odd[i % std::size(odd)];
      const FurHit hit = tree.closest(ray, {});
      ASSERT_EQ(bool(hit), tree.occluded(ray, {}));
      ASSERT_FALSE(std::isnan(hit.distance) || std::isnan(hit.u) || std::isnan(hit.h));
    }
  }
}

}  // namespace
}  // namespace pelage::fur_intersection_test
