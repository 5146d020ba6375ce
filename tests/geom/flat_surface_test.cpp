// SPDX-License-Identifier: Apache-2.0
// Skins of scheme none: polygons as they are.
#include <algorithm>
#include <cmath>
#include <numbers>
#include <numeric>

#include <gtest/gtest.h>

#include "base/error.h"
#include "base/hash.h"
#include "base/parallel.h"
#include "geom/closest_point.h"
#include "geom/limit_surface.h"
#include "geom/polygon_cut.h"
#include "geom/tessellation.h"
#include "tests/geom/cages.h"
#include "tests/support/allocation_meter.h"

namespace pelage::flat_surface_test {
namespace {

std::shared_ptr<const SurfaceTopology> flat(const ControlMesh& mesh) {
  return SurfaceTopology::create(mesh, SubdivisionScheme::kNone, BoundaryRule::kEdgeAndCorner, "test");
}

LimitSurface flat_surface_of(const ControlMesh& mesh) { return {flat(mesh), mesh.positions}; }

double area_along_z(std::span<const V3f> polygon, std::span<const uint32_t> triangle) {
  const V3f a = polygon[triangle[0]], b = polygon[triangle[1]], c = polygon[triangle[2]];
  return 0.5 * double((b - a).cross(c - a).z);
}

TEST(PolygonCut, CoversPolygonsThatAreNotConvex) {
  // A star, a comb, a spiral and an arrow, nearly in the plane z = 0.
  std::vector<std::vector<V3f>> polygons;
  for (const uint32_t points : {5u, 40u}) {
    std::vector<V3f> star;
    for (uint32_t i = 0; i < 2 * points; ++i) {
      const float angle = float(i) * std::numbers::pi_v<float> / float(points), r = i % 2 ? 0.2f : 1.0f;
      star.emplace_back(r * std::cos(angle), r * std::sin(angle), 1e-3f * signed_float(hash64(i)));
    }
    polygons.push_back(star);
  }
  std::vector<V3f> comb;
  for (int i = 0; i < 9; ++i) comb.emplace_back(float(i), i % 2 ? 0.1f : 3.0f, 0.0f);
  comb.emplace_back(8.0f, -1.0f, 0.0f);
  comb.emplace_back(0.0f, -1.0f, 0.0f);
  std::reverse(comb.begin(), comb.end());
  polygons.push_back(comb);
  polygons.push_back({{0, 0, 0},
                      {2, 0, 0},
                      {2, 2, 0},
                      {0, 2, 0},
                      {0, 0.5f, 0},
                      {0.5f, 0.5f, 0},
                      {0.5f, 1.5f, 0},
                      {1.5f, 1.5f, 0},
                      {1.5f, 0.4f, 0},
                      {0, 0.4f, 0}});
  polygons.push_back({{0, 0, 0}, {1, 1, 0}, {0, 0.3f, 0}, {-1, 1, 0}});
  for (const std::vector<V3f>& polygon : polygons) {
    std::vector<uint32_t> vertices(polygon.size()), triangles;
    std::iota(vertices.begin(), vertices.end(), 0u);
    cut_polygon(vertices, polygon, triangles);
    ASSERT_EQ(triangles.size(), 3 * (polygon.size() - 2));
    double area = 0, cut = 0;
    for (size_t i = 0; i < polygon.size(); ++i) {
      const V3f &a = polygon[i], &b = polygon[(i + 1) % polygon.size()];
      area += 0.5 * double(a.x * b.y - a.y * b.x);
    }
    for (size_t t = 0; t < triangles.size(); t += 3) {
      const double one = area_along_z(polygon, std::span(triangles).subspan(t, 3));
      EXPECT_GT(one, 0) << "a triangle is turned over";
      cut += one;
    }
    EXPECT_NEAR(cut, area, 1e-5 * area);
  }
}

TEST(PolygonCut, TakesAnyPolygon) {
  for (uint64_t seed = 0; seed < 300; ++seed) {
    const size_t n = 4 + seed % 20;
    std::vector<V3f> polygon;
    std::vector<uint32_t> vertices, triangles;
    for (uint64_t i = 0; i < n; ++i) {
      vertices.push_back(static_cast<uint32_t>(seed % 3 == 0 ? hash64(seed, i) % n : i));
      const uint64_t at = hash64(seed, vertices.back());
      polygon.emplace_back(signed_float(at), signed_float(mix64(at)), 0.0f);
      if (seed % 5 == 0) polygon.back() = V3f(0);
    }
    cut_polygon(vertices, polygon, triangles);
    EXPECT_EQ(triangles.size() % 3, 0u);
    EXPECT_LE(triangles.size(), 3 * (n - 2));
    if (seed % 3) {
      EXPECT_EQ(triangles.size(), 3 * (n - 2));
    }
    for (size_t t = 0; t < triangles.size(); t += 3) {
      EXPECT_NE(vertices[triangles[t]], vertices[triangles[t + 1]]);
      EXPECT_NE(vertices[triangles[t + 1]], vertices[triangles[t + 2]]);
      EXPECT_NE(vertices[triangles[t + 2]], vertices[triangles[t]]);
    }
  }
}

TEST(FlatSurface, MeetsTheVerticesOfItsMesh) {
  for (const ControlMesh& mesh : {bumpy_sphere(20), prism_cage(7), torus_cage(6, 5), octahedron_cage()}) {
    const LimitSurface surface = flat_surface_of(mesh);
    const SurfaceTopology& topology = surface.topology();
    EXPECT_TRUE(topology.is_triangular());
    EXPECT_EQ(topology.face_count(), mesh.face_vertices.size() - 2 * mesh.face_sizes.size());
    std::vector<bool> met(mesh.positions.size());
    for (uint32_t face = 0; face < topology.face_count(); ++face) {
      ASSERT_LT(topology.cage_face(face), mesh.face_count());
      for (const V2f& uv : {V2f(0, 0), V2f(1, 0), V2f(0, 1)}) {
        const V3f at = surface.evaluate(face, uv.x, uv.y).position;
        size_t vertex = 0;
        while (vertex < met.size() && (mesh.positions[vertex] - at).length() > 1e-6f) ++vertex;
        ASSERT_LT(vertex, met.size());
        met[vertex] = true;
      }
      // Beyond the third side lies its end.
      EXPECT_EQ(surface.evaluate(face, 1, 1).position, surface.evaluate(face, 0.5f, 0.5f).position);
    }
    EXPECT_EQ(std::count(met.begin(), met.end(), false), 0);
  }
}

TEST(FlatSurface, FramesAreSmooth) {
  const ControlMesh mesh = bumpy_sphere(40);
  const LimitSurface surface = flat_surface_of(mesh);
  const SurfaceTopology& topology = surface.topology();
  double off = 0, off_flat = 0;
  for (uint32_t face = 0; face < topology.face_count(); ++face) {
    for (int side = 0; side < 3; ++side) {
      const int other = topology.neighbour(face, side);
      ASSERT_GE(other, 0);
      int back = 0;
      while (topology.neighbour(static_cast<uint32_t>(other), back) != static_cast<int>(face)) ++back;
      for (const float t : {0.0f, 0.4f, 1.0f}) {
        const auto along = [](int s, float x) {
          return s == 0 ? V2f(x, 0) : s == 1 ? V2f(1 - x, x) : V2f(0, 1 - x);
        };
        const V2f here = along(side, t), there = along(back, 1 - t);
        const Frame a = surface.frame(face, here.x, here.y);
        const Frame b = surface.frame(static_cast<uint32_t>(other), there.x, there.y);
        ASSERT_LT((a.normal - b.normal).length(), 1e-5f) << "across an edge";
        ASSERT_NEAR(a.tangent.dot(a.normal), 0, 1e-6f);
        ASSERT_NEAR(a.bitangent.dot(a.tangent), 0, 1e-6f);
        ASSERT_NEAR(a.tangent.length(), 1, 1e-6f);
        EXPECT_EQ(LimitSurface::frame_of(surface.evaluate(face, here.x, here.y)).normal, a.normal);
      }
    }
    // Nearer to the normals of what the mesh was made from than its triangles are, but in their middle.
    const SurfacePoint p = surface.evaluate(face, 0.05f, 0.1f);
    const V3f truth = bumpy_normal(p.position);
    off += double((surface.frame(face, 0.05f, 0.1f).normal - truth).length());
    off_flat += double((p.du.cross(p.dv).normalized() - truth).length());
  }
  EXPECT_LT(off, 0.5 * off_flat);
}

TEST(FlatSurface, FramesAreFiniteWhereThereIsNoNormal) {
  ControlMesh point = octahedron_cage(), line = octahedron_cage(), tiny = octahedron_cage();
  for (V3f& p : point.positions) p = V3f(3);
  for (V3f& p : line.positions) p = V3f(p.x, 0, 0);
  for (V3f& p : tiny.positions) p *= 1e-25f;
  // Both sides of one triangle: normals cancel out.
  const ControlMesh sheet = make_cage({{0, 0, 0}, {1, 0, 0}, {0, 1, 0}}, {{0, 1, 2}, {2, 1, 0}});
  for (const ControlMesh& mesh : {point, line, tiny, sheet}) {
    const LimitSurface surface = flat_surface_of(mesh);
    for (uint32_t face = 0; face < surface.topology().face_count(); ++face) {
      for (const float u : {0.0f, 0.3f, 1.0f}) {
        const Frame frame = surface.frame(face, u, 0.2f);
        EXPECT_NEAR(frame.normal.length(), 1, 1e-5f);
        EXPECT_NEAR(frame.tangent.length(), 1, 1e-5f);
        EXPECT_NEAR(frame.normal.dot(frame.tangent), 0, 1e-5f);
      }
    }
  }
  EXPECT_LT(
      (flat_surface_of(tiny).frame(0, 0, 0).normal - flat_surface_of(octahedron_cage()).frame(0, 0, 0).normal)
          .length(),
      1e-5f);
}

TEST(FlatSurface, APartIsTheSameBitByBit) {
  const ControlMesh mesh = bumpy_sphere(24);
  const LimitSurface whole = flat_surface_of(mesh);
  std::vector<uint32_t> faces;
  for (uint32_t f = 0; f < whole.topology().face_count(); ++f) {
    if (hash64(f) % 5 == 0) faces.push_back(f);
  }
  const LimitSurface part(whole.shared_topology(), mesh.positions, faces);
  EXPECT_EQ(part.bytes(), whole.topology().pose_bytes(faces).held);
  EXPECT_EQ(whole.bytes(), whole.topology().pose_bytes().held);
  for (const uint32_t face : faces) {
    const SurfacePoint a = whole.evaluate(face, 0.3f, 0.4f), b = part.evaluate(face, 0.3f, 0.4f);
    EXPECT_EQ(a.position, b.position);
    EXPECT_EQ(a.smooth_normal, b.smooth_normal);
  }
}

TEST(FlatSurface, IsItsOwnTessellation) {
  View near;
  near.position = {0, 0, 1.2f};
  near.focal_pixels = 1e5f;
  for (const ControlMesh& mesh : {bumpy_sphere(12), torus_cage(5, 4)}) {
    const LimitSurface surface = flat_surface_of(mesh);
    const SkinMesh skin = tessellate(std::span(&surface, 1), near, {}, Workers(2));
    EXPECT_EQ(skin.triangle_count(), surface.topology().face_count());
    EXPECT_EQ(skin.vertex_count(), mesh.positions.size());
    for (size_t t = 0; t < skin.triangle_count(); ++t) EXPECT_EQ(skin.faces[t], t);
  }
}

TEST(FlatSurface, TakesWhatSubdivisionDoesNot) {
  // Three faces at an edge, one turned over, a vertex of two fans, one that no face has, 1,500 faces at one
  // vertex.
  const ControlMesh book = make_cage({{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {0, 0, 1}, {0, -1, 0}, {9, 9, 9}},
                                     {{0, 1, 2}, {0, 1, 3}, {1, 0, 4}, {1, 0, 2}});
  const LimitSurface surface = flat_surface_of(book);
  EXPECT_EQ(surface.topology().neighbour(0, 0), -1);
  const SkinMesh skin = tessellate(std::span(&surface, 1), View(), {}, Workers(1));
  EXPECT_EQ(skin.triangle_count(), 4u);
  ControlMesh hub = make_cage({{0, 0, 1}}, {});
  for (uint32_t i = 0; i < 1500; ++i) {
    const float angle = float(i) * 2 * std::numbers::pi_v<float> / 1500;
    hub.positions.emplace_back(std::cos(angle), std::sin(angle), 0.0f);
    hub.face_sizes.push_back(3);
    hub.face_vertices.insert(hub.face_vertices.end(), {0, 1 + i, 1 + (i + 1) % 1500});
  }
  EXPECT_LT((flat_surface_of(hub).frame(7, 0, 0).normal - V3f(0, 0, 1)).length(), 1e-4f);
  EXPECT_THROW(flat(make_cage({{0, 0, 0}, {1, 0, 0}}, {{0, 1, 1}})), Error);
}

TEST(FlatSurface, HolesAndTextureCoordinatesFollowTheirPolygons) {
  ControlMesh grid = grid_cage(3, 2);
  grid.holes = {1};
  const LimitSurface surface = flat_surface_of(grid);
  const SurfaceTopology& topology = surface.topology();
  ASSERT_EQ(topology.face_count(), 12u);
  for (uint32_t face = 0; face < 12; ++face) {
    EXPECT_EQ(topology.is_hole(face), topology.cage_face(face) == 1);
    const V3f at = surface.evaluate(face, 0.2f, 0.5f).position;
    EXPECT_LT((topology.texture_coordinates(face, 0.2f, 0.5f) - V2f(at.x / 3, at.y / 2)).length(), 1e-6f);
  }
  EXPECT_EQ(tessellate(std::span(&surface, 1), View(), {}, Workers(1)).triangle_count(), 10u);
}

TEST(FlatSurface, HashesTellCutsApart) {
  // The same corners, of which other ones lie nearer together.
  const auto quad = [](float x) {
    return make_cage({{0, 0, 0}, {x, 0, 0}, {1, 1, 0}, {1 - x, 1, 0}}, {{0, 1, 2, 3}});
  };
  EXPECT_TRUE(flat(quad(0.7f))->hash() == flat(quad(0.8f))->hash());
  EXPECT_FALSE(flat(quad(2))->hash() == flat(quad(0.7f))->hash());
  ControlMesh moved = bumpy_sphere(8);
  const ContentHash before = flat(moved)->hash();
  moved.positions[3] *= 1.5f;
  EXPECT_TRUE(flat(moved)->hash() == before);
}

// 400 bytes a face for topology, surface and root lookup: what is held, and the most while it is made.
TEST(FlatSurface, TakesLittleMemory) {
  for (const bool has_uv : {false, true}) {
    ControlMesh mesh = bumpy_sphere(134);  // 35,378 triangles
    if (has_uv) {
      mesh.uv.resize(mesh.positions.size());
      mesh.face_uv = mesh.face_vertices;
    }
    const size_t faces = mesh.face_count();
    EXPECT_GT(faces, 35000u);
    View anywhere;
    reset_peak();
    const size_t before = live_bytes();
    const auto topology = flat(mesh);
    const size_t made = peak_bytes() - before, held = live_bytes() - before;
    EXPECT_LE(held, topology->bytes() + 4096);
    EXPECT_GE(held + 4096, topology->bytes());
    EXPECT_LE(made, 200 * faces);
    const LimitSurface surface(topology, mesh.positions);
    const SkinMesh skin = tessellate(std::span(&surface, 1), anywhere, {}, Workers(1));
    const ClosestPointTree tree(skin, 0);
    EXPECT_LE(live_bytes() - before, 300 * faces);
    EXPECT_LE(peak_bytes() - before, 400 * faces);
  }
}

}  // namespace
}  // namespace pelage::flat_surface_test
