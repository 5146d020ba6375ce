// SPDX-License-Identifier: Apache-2.0
#include "geom/closest_point.h"

#include <algorithm>

#include <gtest/gtest.h>

#include "base/hash.h"
#include "base/parallel.h"
#include "geom/tessellation.h"
#include "geom/triangle_distance.h"
#include "tests/geom/cages.h"

namespace pelage {
namespace {

constexpr float kFar = 1e9f;

V3f random_point(uint64_t i, float reach) {
  return V3f(signed_float(hash64(i, 1)), signed_float(hash64(i, 2)), signed_float(hash64(i, 3))) * reach;
}

SkinMesh skin_of(const ControlMesh& cage, float edge_pixels = 3) {
  const LimitSurface surface(
      SurfaceTopology::create(cage, SubdivisionScheme::kCatmullClark, BoundaryRule::kEdgeAndCorner, "test"),
      cage.positions);
  View view;
  view.position = {0.5f, 0.3f, 3.2f};
  view.focal_pixels = 40;
  return tessellate(std::span(&surface, 1), view, {edge_pixels, 32}, Workers(1));
}

SkinMesh triangle_soup(size_t count, float size) {
  SkinMesh mesh;
  for (size_t t = 0; t < count; ++t) {
    const V3f centre = random_point(t * 7 + 1, 1);
    for (size_t i = 0; i < 3; ++i) {
      const V3f p = centre + random_point(t * 7 + 2 + i, size);
      mesh.positions.insert(mesh.positions.end(), {p.x, p.y, p.z});
      mesh.normals.insert(mesh.normals.end(), {0, 0, 1});
      mesh.triangles.push_back(static_cast<uint32_t>(t * 3 + i));
    }
  }
  mesh.faces.resize(count);
  mesh.vertex_uv.resize(count * 3);
  return mesh;
}

/// Lowest value of a convex function on [0, 1].
template <class F>
double lowest(const F& f) {
  double a = 0, b = 1;
  for (int i = 0; i < 70; ++i) {
    const double c = (2 * a + b) / 3, d = (a + 2 * b) / 3;
    (f(c) < f(d) ? b : a) = f(c) < f(d) ? d : c;
  }
  return f((a + b) / 2);
}

/// Distance to a triangle by search: it is convex along and across rows of the triangle.
double searched_distance(const V3d corner[3], const V3d& point) {
  return lowest([&](double u) {
    return lowest([&](double w) {
      const double v = w * (1 - u);
      return (corner[0] * (1 - u - v) + corner[1] * u + corner[2] * v - point).length();
    });
  });
}

TEST(TriangleDistance, AgreesWithASearch) {
  for (uint64_t k = 0; k < 300; ++k) {
    V3d corner[3];
    TrianglePacket packet{};
    for (uint64_t i = 0; i < 3; ++i) {
      V3f p = random_point(k * 10 + i, 1);
      if (k % 3 == 1) p.z = 0.01f * p.z;             // thin
      if (k % 10 == 9 && i > 0) p = V3f(corner[0]);  // no area
      corner[i] = V3d(p);
      packet.corner[i] = {four(p.x), four(p.y), four(p.z)};
    }
    const V3f point = random_point(k * 10 + 5, 2);
    const double truth = searched_distance(corner, V3d(point));
    const Four squares = packet_distances(packet, point);
    EXPECT_NEAR(std::sqrt(squares[0]), truth, 1e-5) << k;
    EXPECT_EQ(squares[0], squares[3]);
    const NearestOnTriangle nearest = nearest_on_triangle({corner[0], corner[1], corner[2]}, V3d(point));
    EXPECT_NEAR((nearest.position - V3d(point)).length(), truth, 1e-6) << k;
    const V3d w = nearest.weights;
    EXPECT_NEAR(w.x + w.y + w.z, 1, 1e-12);
    EXPECT_LT((corner[0] * w.x + corner[1] * w.y + corner[2] * w.z - nearest.position).length(), 1e-9);
  }
}

/// The nearest triangle by asking all of them.
uint32_t brute_force(const SkinMesh& mesh, const V3f& point, double& distance) {
  uint32_t best = 0;
  distance = 1e300;
  for (uint32_t t = 0; t < mesh.triangle_count(); ++t) {
    const Triangle triangle{V3d(mesh.position(mesh.triangles[t * 3])),
                            V3d(mesh.position(mesh.triangles[t * 3 + 1])),
                            V3d(mesh.position(mesh.triangles[t * 3 + 2]))};
    const double d = (nearest_on_triangle(triangle, V3d(point)).position - V3d(point)).length();
    if (d < distance) distance = d, best = t;
  }
  return best;
}

TEST(ClosestPointTree, FindsWhatBruteForceFinds) {
  const SkinMesh meshes[] = {skin_of(prism_cage(5)), skin_of(torus_cage(8, 6)), triangle_soup(1000, 0.1f),
                             triangle_soup(5, 1), triangle_soup(1, 1)};
  for (const SkinMesh& mesh : meshes) {
    const ClosestPointTree tree(mesh, 0);
    for (uint64_t i = 0; i < 500; ++i) {
      const V3f point = random_point(i, i % 2 ? 1.5f : 4.0f);
      double truth = 0;
      brute_force(mesh, point, truth);
      ClosestPoint found;
      ASSERT_TRUE(tree.closest(point, kFar, found));
      ClosestPoint place;
      ASSERT_TRUE(tree.closest_position(point, kFar, place));
      EXPECT_EQ(place.position, found.position);
      EXPECT_EQ(place.distance, found.distance);
      EXPECT_NEAR(found.distance, truth, 2e-6 * (1 + truth));
      EXPECT_NEAR((found.position - point).length(), truth, 1e-6 * (1 + truth));
      EXPECT_NEAR(found.normal.length(), 1, 1e-6);
      // What is just out of reach is not found, what is just within is.
      EXPECT_FALSE(tree.closest(point, static_cast<float>(truth) * 0.9999f, found));
      EXPECT_TRUE(tree.closest(point, static_cast<float>(truth) * 1.0001f, found));
    }
  }
}

TEST(ClosestPointTree, FarFromTheOriginNothingIsMissed) {
  SkinMesh mesh = triangle_soup(400, 0.1f);
  for (float& x : mesh.positions) x += 1000;
  const ClosestPointTree tree(mesh, 0);
  for (uint64_t i = 0; i < 300; ++i) {
    const V3f point = random_point(i, 1) + V3f(1000);
    double truth = 0;
    brute_force(mesh, point, truth);
    ClosestPoint found;
    ASSERT_TRUE(tree.closest(point, kFar, found));
    EXPECT_NEAR(found.distance, truth, 1e-4);
  }
}

/// Where a closed skin winds around a point, by the solid angles of its triangles [VanOosterom83].
double winding_number(const SkinMesh& mesh, const V3f& point) {
  double sum = 0;
  for (size_t t = 0; t < mesh.triangle_count(); ++t) {
    V3d a[3];
    for (size_t i = 0; i < 3; ++i) a[i] = V3d(mesh.position(mesh.triangles[t * 3 + i]) - point);
    const double la = a[0].length(), lb = a[1].length(), lc = a[2].length();
    const double below = la * lb * lc + a[0].dot(a[1]) * lc + a[1].dot(a[2]) * la + a[2].dot(a[0]) * lb;
    sum += 2 * std::atan2(a[0].dot(a[1].cross(a[2])), below);
  }
  return sum / (4 * M_PI);
}

TEST(ClosestPointTree, InsideIsWhereTheSkinWindsAround) {
  ControlMesh star = poles_cage(9);  // dented, so that edges and corners point inwards as well
  for (size_t i = 2; i < star.positions.size(); i += 4) star.positions[i] *= 0.4f;
  ControlMesh cube = cube_cage();
  cube.corners = {{0, 10}, {1, 10}, {2, 10}, {3, 10}, {4, 10}, {5, 10}, {6, 10}, {7, 10}};
  const SkinMesh meshes[] = {skin_of(star, 8), skin_of(torus_cage(6, 5), 20), skin_of(cube, 1e9f)};
  for (const SkinMesh& mesh : meshes) {
    const ClosestPointTree tree(mesh, 0);
    int inside = 0;
    for (uint64_t i = 0; i < 2000; ++i) {
      const V3f point = random_point(i, 1.8f);
      const double winding = winding_number(mesh, point);
      if (std::abs(winding - std::round(winding)) > 1e-3) continue;  // on the skin
      ClosestPoint found;
      ASSERT_TRUE(tree.closest(point, kFar, found));
      EXPECT_EQ(found.inside, winding > 0.5) << point << " distance " << found.distance;
      inside += found.inside;
    }
    EXPECT_GT(inside, 50);
    EXPECT_LT(inside, 1950);
  }
}

TEST(ClosestPointTree, TheLowerNumberWins) {
  SkinMesh mesh = triangle_soup(1, 1);
  const size_t copies = 37;
  for (size_t copy = 1; copy < copies; ++copy) {
    for (uint32_t i = 0; i < 3; ++i) mesh.triangles.push_back(i);
  }
  mesh.faces.resize(copies);
  mesh.vertex_uv.resize(copies * 3);
  const ClosestPointTree tree(mesh, 0);
  for (uint64_t i = 0; i < 50; ++i) {
    ClosestPoint found;
    ASSERT_TRUE(tree.closest(random_point(i, 2), kFar, found));
    EXPECT_EQ(found.triangle, 0u);
  }
  // The middle of a cube is as far from all of its faces.
  ControlMesh cage = cube_cage();
  const LimitSurface surface(
      SurfaceTopology::create(cage, SubdivisionScheme::kBilinear, BoundaryRule::kEdgeAndCorner, "test"),
      cage.positions);
  const SkinMesh cube = tessellate(std::span(&surface, 1), View(), {1e9f, 1}, Workers(1));
  ClosestPoint found;
  ASSERT_TRUE(ClosestPointTree(cube, 0).closest(V3f(0), kFar, found));
  EXPECT_EQ(found.triangle, 0u);
  EXPECT_TRUE(found.inside);
  EXPECT_EQ(found.distance, 1);
}

TEST(ClosestPointTree, OddInputs) {
  const SkinMesh empty;
  ClosestPoint found;
  EXPECT_FALSE(ClosestPointTree(empty, 0).closest(V3f(0), kFar, found));
  const SkinMesh mesh = skin_of(cube_cage());
  const ClosestPointTree tree(mesh, 0);
  EXPECT_FALSE(tree.closest(V3f(NAN, 0, 0), kFar, found));
  EXPECT_FALSE(tree.closest(V3f(0), NAN, found));
  EXPECT_FALSE(tree.closest(V3f(0), -1, found));
  EXPECT_TRUE(tree.closest(V3f(0), INFINITY, found));
  EXPECT_TRUE(tree.closest(mesh.position(3), 0, found)) << "a vertex lies on the skin";
  EXPECT_GE(tree.bytes(), mesh.triangle_count() * 40);
}

TEST(ClosestPointTree, NormalsTooSmallForADirectionMeanNone) {
  // Eight triangles almost without area along two segments. The sum of their normals is denormal.
  const float u = std::numeric_limits<float>::denorm_min();
  SkinMesh mesh;
  const auto add = [&](const V3f& a, const V3f& b, const V3f& c) {
    for (const V3f& p : {a, b, c}) {
      mesh.triangles.push_back(static_cast<uint32_t>(mesh.positions.size() / 3));
      mesh.positions.insert(mesh.positions.end(), {p.x, p.y, p.z});
      mesh.normals.insert(mesh.normals.end(), {0, 0, 1});
    }
  };
  add({0, 0, -0.5f}, {0, 0, 0.5f}, {2 * u, u, 0});
  for (int i = 0; i < 3; ++i) add({0, 0, -0.5f}, {0, 0, 0.5f}, {0, 0, 0});
  for (int i = 0; i < 4; ++i) add({1, 0, 1.05f}, {1, 0, 2}, {1, 0, 1.5f});
  ClosestPoint found;
  ASSERT_TRUE(ClosestPointTree(mesh, 0).closest(V3f(1, 0, 0), kFar, found));
  EXPECT_NEAR(found.distance, 1, 1e-6f);
}

TEST(ClosestPointTree, TakesNoMoreMemoryThanIsReserved) {
  // SkinBalls::temporary_bytes() counts 100 bytes per triangle, with half a vertex each.
  for (const int triangles : {1024, 4096, 5000, 8192, 20000, 32768}) {
    const SkinMesh mesh = triangle_soup(triangles, 0.05f);
    EXPECT_LE(ClosestPointTree(mesh, 0).bytes(), 94 * mesh.triangle_count() + 4 * mesh.vertex_count() + 4096)
        << triangles;
  }
}

TEST(ClosestPointTree, UsesTheKeyItIsMadeFor) {
  SkinMesh mesh = triangle_soup(20, 0.5f);
  const size_t floats = mesh.positions.size();
  mesh.motion_keys = 2;
  for (size_t i = 0; i < floats; ++i) mesh.positions.push_back(mesh.positions[i] + 10);
  mesh.normals.insert(mesh.normals.end(), mesh.normals.begin(), mesh.normals.begin() + long(floats));
  ClosestPoint found;
  EXPECT_FALSE(ClosestPointTree(mesh, 0).closest(V3f(10), 3, found));
  EXPECT_TRUE(ClosestPointTree(mesh, 1).closest(V3f(10), 3, found));
}

}  // namespace
}  // namespace pelage
