// SPDX-License-Identifier: Apache-2.0
#include "geom/skin_balls.h"

#include <cmath>
#include <limits>
#include <numbers>

#include <gtest/gtest.h>

#include "base/hash.h"
#include "geom/triangle_distance.h"
#include "geom/winding.h"
#include "tests/geom/eared_skin.h"
#include "tests/support/quiet_job.h"

namespace pelage::skin_balls_test {
namespace {

V3f random_point(uint64_t i, float reach) {
  return V3f(signed_float(hash64(i, 1)), signed_float(hash64(i, 2)), signed_float(hash64(i, 3))) * reach;
}

/// Winding number as the sum of signed solid angles [VanOosterom83]: the slow reference.
int solid_angles(const SkinMesh& mesh, const V3f& point, int key) {
  double sum = 0;
  for (size_t t = 0; t < mesh.triangle_count(); ++t) {
    V3d corner[3];
    for (size_t i = 0; i < 3; ++i)
      corner[i] = V3d(mesh.position(mesh.triangles[3 * t + i], key)) - V3d(point);
    const double a = corner[0].length(), b = corner[1].length(), c = corner[2].length();
    const double over = corner[0].dot(corner[1].cross(corner[2]));
    const double under = a * b * c + corner[0].dot(corner[1]) * c + corner[1].dot(corner[2]) * a +
                         corner[2].dot(corner[0]) * b;
    sum += 2 * std::atan2(over, under);
  }
  return static_cast<int>(std::lround(sum / (4 * std::numbers::pi)));
}

double distance(const SkinMesh& mesh, const V3f& point, float time) {
  double nearest = std::numeric_limits<double>::max();
  for (size_t t = 0; t < mesh.triangle_count(); ++t) {
    Triangle triangle{};
    for (size_t i = 0; i < 3; ++i)
      triangle.corner[i] = V3d(position_at(mesh, mesh.triangles[3 * t + i], time));
    nearest = std::min(nearest, (nearest_on_triangle(triangle, V3d(point)).position - V3d(point)).length());
  }
  return nearest;
}

TEST(WindingNumbers, AgreeWithSolidAngles) {
  const SkinMesh ball = flat_skin(shaken(bumpy_sphere(12), 0.05f));
  SkinMesh twice = ball;  // another ball inside that overlaps the first, and one inside out
  append(twice, flat_skin(bumpy_sphere(10)), V3f(0.7f, 0.2f, 0));
  append(twice, inside_out(flat_skin(bumpy_sphere(8))), V3f(-0.9f, 0, 0.1f));
  for (const SkinMesh& mesh : {ball, inside_out(ball), twice, eared_skin()}) {
    ASSERT_TRUE(is_closed(mesh));
    const WindingNumbers numbers(mesh, 0);
    int seen = 0;
    for (uint64_t i = 0; i < 400; ++i) {
      V3f at = random_point(i, 1.5f);
      if (i % 4 == 0) {  // straight below a vertex
        const V3f vertex = mesh.position(hash64(i) % mesh.vertex_count());
        at = V3f(vertex.x, vertex.y, at.z);
      }
      if (distance(mesh, at, 0) < 1e-4) continue;
      const int expected = solid_angles(mesh, at, 0);
      ASSERT_EQ(numbers.at(at), expected) << i;
      seen += expected != 0;
    }
    EXPECT_GT(seen, 20);
  }
}

TEST(WindingNumbers, AnEdgeUsedOnceOpensAMesh) {
  SkinMesh mesh = eared_skin();
  mesh.triangles.resize(mesh.triangles.size() - 3);
  EXPECT_FALSE(is_closed(mesh));
  mesh = eared_skin();
  std::swap(mesh.triangles[0], mesh.triangles[1]);  // one triangle inside out
  EXPECT_FALSE(is_closed(mesh));
}

TEST(WindingNumbers, SeamsWhereVerticesCoincideInEveryPoseDoNotOpenAMesh) {
  SkinMesh mesh = split_at_edges(moving(eared_skin()));
  EXPECT_TRUE(is_closed(mesh));
  mesh.positions.back() += 1e-5f;  // the seam opens in the last pose
  EXPECT_FALSE(is_closed(mesh));
}

TEST(SkinBalls, DoNotDependOnSeams) {
  QuietJob job{1};
  const SkinMesh mesh = moving(eared_skin());
  const SkinBalls whole(mesh, job), split(split_at_edges(mesh), job);
  ASSERT_EQ(whole.size(), split.size());
  for (uint32_t i = 0; i < whole.size(); ++i) {
    EXPECT_EQ(whole.ball(i, 0.3f).center, split.ball(i, 0.3f).center);
    EXPECT_EQ(whole.ball(i, 0).radius, split.ball(i, 0).radius);
  }
}

TEST(SkinBalls, HoldNoSurfaceOverTheWholeShutter) {
  QuietJob job{1};
  for (const SkinMesh& mesh : {flat_skin(bumpy_sphere(16)), eared_skin(), moving(eared_skin())}) {
    const SkinBalls balls(mesh, job);
    ASSERT_GT(balls.size(), 50u);
    for (uint32_t i = 0; i < balls.size(); i += 7) {
      for (const float time : {0.0f, 0.13f, 0.5f, 0.77f, 1.0f}) {
        const SkinBall ball = balls.ball(i, time);
        ASSERT_GT(ball.radius, 0);
        ASSERT_GT(distance(mesh, ball.center, time), ball.radius) << i << " at " << time;
      }
      ASSERT_NE(solid_angles(mesh, balls.ball(i, 0).center, 0), 0);
      ASSERT_NE(solid_angles(mesh, balls.ball(i, 1).center, mesh.motion_keys - 1), 0);
    }
  }
}

TEST(SkinBalls, FillASphere) {
  QuietJob job{1};
  const SkinMesh mesh = sphere_skin(40);
  const SkinBalls balls(mesh, job);
  double sum = 0;
  for (uint32_t i = 0; i < balls.size(); ++i) sum += balls.ball(i, 0).radius;
  EXPECT_GT(sum / static_cast<double>(balls.size()), 0.9);
  for (size_t v = 0; v < mesh.vertex_count(); ++v) EXPECT_TRUE(balls.find(mesh.position(v))) << v;
}

TEST(SkinBalls, OpenAndInvertedSkinsHaveNone) {
  QuietJob job{1};
  SkinMesh open = eared_skin();
  open.triangles.resize(open.triangles.size() - 3);
  EXPECT_EQ(SkinBalls(open, job).size(), 0u);
  EXPECT_EQ(SkinBalls(flat_skin(grid_cage(4, 4)), job).size(), 0u);
  EXPECT_EQ(SkinBalls(inside_out(sphere_skin(12)), job).size(), 0u);
  EXPECT_EQ(SkinBalls(SkinMesh{}, job).size(), 0u);
}

TEST(SkinBalls, AreTheSameForAnyNumberOfThreads) {
  const SkinMesh mesh = moving(eared_skin());
  QuietJob one{1}, many{4};
  const SkinBalls a(mesh, one), b(mesh, many);
  ASSERT_EQ(a.size(), b.size());
  for (uint32_t i = 0; i < a.size(); ++i) {
    EXPECT_EQ(a.ball(i, 0.3f).center, b.ball(i, 0.3f).center);
    EXPECT_EQ(a.ball(i, 0).radius, b.ball(i, 0).radius);
  }
}

}  // namespace
}  // namespace pelage::skin_balls_test
