// SPDX-License-Identifier: Apache-2.0
#include "geom/tessellation.h"

#include <algorithm>
#include <map>
#include <set>

#include "base/hash.h"
#include "base/parallel.h"
#include "geom/io/obj_file.h"
#include "tests/geom/surface_cages.h"
#include "tests/support/data.h"

namespace pelage {
namespace {

SkinMesh tessellate_one(const LimitSurface& surface, const View& view, TessellationOptions options = {}) {
  return tessellate(std::span(&surface, 1), view, options, Workers(2));
}

struct EdgeCount {
  size_t edges = 0;
  size_t not_twice = 0;  // not once in each direction
  long euler = 0;
};

EdgeCount count_edges(const SkinMesh& mesh) {
  std::map<std::pair<uint32_t, uint32_t>, int> directed;
  std::set<uint32_t> used(mesh.triangles.begin(), mesh.triangles.end());
  for (size_t t = 0; t < mesh.triangle_count(); ++t) {
    for (size_t i = 0; i < 3; ++i)
      ++directed[{mesh.triangles[t * 3 + i], mesh.triangles[t * 3 + (i + 1) % 3]}];
  }
  EdgeCount result;
  for (const auto& [edge, count] : directed) {
    const auto back = directed.find({edge.second, edge.first});
    if (count != 1 || back == directed.end() || back->second != 1) ++result.not_twice;
    if (edge.first < edge.second || back == directed.end()) ++result.edges;
  }
  EXPECT_EQ(used.size(), mesh.vertex_count()) << "vertices that no triangle uses";
  result.euler = long(used.size()) - long(result.edges) + long(mesh.triangle_count());
  return result;
}

long cage_euler(const ControlMesh& cage) {
  std::set<std::pair<uint32_t, uint32_t>> edges;
  size_t first = 0;
  for (uint32_t size : cage.face_sizes) {
    for (uint32_t i = 0; i < size; ++i) {
      edges.insert(std::minmax(cage.face_vertices[first + i], cage.face_vertices[first + (i + 1) % size]));
    }
    first += size;
  }
  const std::set<uint32_t> used(cage.face_vertices.begin(), cage.face_vertices.end());
  return long(used.size()) - long(edges.size()) + long(cage.face_count());
}

/// Close to one end of a cage of radius about 2, so that rates differ a lot over it.
View close_view() {
  View view;
  view.position = {0.5f, 0.3f, 3.2f};
  view.focal_pixels = 40;
  view.near_distance = 0.01f;
  return view;
}

void expect_on_surface(const SkinMesh& mesh, const LimitSurface& surface) {
  for (size_t t = 0; t < mesh.triangle_count(); ++t) {
    V3f corners[3];
    for (size_t i = 0; i < 3; ++i) {
      const V2f uv = mesh.vertex_uv[t * 3 + i];
      corners[i] = mesh.position(mesh.triangles[t * 3 + i]);
      const V3f expected = surface.evaluate(mesh.faces[t], uv.x, uv.y).position;
      ASSERT_LT((corners[i] - expected).length(), 2e-4f) << "triangle " << t << " corner " << i;
    }
    const V3f normal = (corners[1] - corners[0]).cross(corners[2] - corners[0]);
    ASSERT_GT(normal.dot(mesh.normal(mesh.triangles[t * 3])), 0) << "triangle " << t << " faces inwards";
  }
}

TEST(Tessellation, ClosedSkinsStayClosed) {
  struct Case {
    const char* name;
    ControlMesh cage;
    SubdivisionScheme scheme;
  };
  const Case cases[] = {
      {"cube", cube_cage(), SubdivisionScheme::kCatmullClark},
      {"torus", torus_cage(7, 5), SubdivisionScheme::kCatmullClark},
      {"pentagons", prism_cage(5), SubdivisionScheme::kCatmullClark},
      {"triangles", prism_cage(3), SubdivisionScheme::kCatmullClark},
      {"polygon of 300", prism_cage(300), SubdivisionScheme::kCatmullClark},
      {"poles", poles_cage(13), SubdivisionScheme::kCatmullClark},
      {"loop", octahedron_cage(), SubdivisionScheme::kLoop},
      {"bilinear", prism_cage(5), SubdivisionScheme::kBilinear},
      {"none", bumpy_sphere(9), SubdivisionScheme::kNone},
  };
  for (const Case& c : cases) {
    SCOPED_TRACE(c.name);
    const LimitSurface surface = surface_of(c.cage, c.scheme);
    for (float edge_pixels : {1.5f, 4.0f, 15.0f, 1e9f}) {
      const SkinMesh mesh = tessellate_one(surface, close_view(), {edge_pixels, 32});
      const EdgeCount count = count_edges(mesh);
      EXPECT_EQ(count.not_twice, 0u) << edge_pixels;
      EXPECT_EQ(count.euler, cage_euler(c.cage)) << edge_pixels;
      expect_on_surface(mesh, surface);
    }
  }
}

TEST(Tessellation, EdgesAreAsShortAsAsked) {
  const LimitSurface surface = surface_of(torus_cage(7, 5));
  const View view = close_view();
  const SkinMesh mesh = tessellate_one(surface, view, {3, 1000});
  float longest = 0;
  for (size_t t = 0; t < mesh.triangle_count(); ++t) {
    for (size_t i = 0; i < 3; ++i) {
      const V3f a = mesh.position(mesh.triangles[t * 3 + i]),
                b = mesh.position(mesh.triangles[t * 3 + (i + 1) % 3]);
      longest = std::max(longest, (a - b).length() * view.pixels_per_unit(0.5f * (a + b)));
    }
  }
  // Diagonals, and speeds that vary along a line.
  EXPECT_LT(longest, 3 * 2.0f);
  EXPECT_GT(longest, 3 * 0.9f);
  // What is far away has few triangles.
  View far = view;
  far.position = {0, 0, 1e5f};
  EXPECT_EQ(tessellate_one(surface, far, {3, 1000}).triangle_count(), 70u);
}

TEST(Tessellation, RatesFollowTheViewEdgeByEdge) {
  ControlMesh cage = grid_cage(40, 1);
  View view;
  view.position = {0, 0.5f, 1};
  view.focal_pixels = 100;
  const SkinMesh mesh = tessellate_one(surface_of(cage), view, {4, 64});
  std::vector<size_t> per_face(40);
  for (uint32_t face : mesh.faces) ++per_face[face];
  EXPECT_GT(per_face[0], 20 * per_face[39]);
  for (size_t i = 1; i < 40; ++i) EXPECT_LE(per_face[i], per_face[i - 1]);
}

TEST(Tessellation, HolesAreLeftOutAndBordersKept) {
  ControlMesh cage = grid_cage(3, 3);
  cage.holes = {4};
  const LimitSurface surface = surface_of(cage);
  const SkinMesh mesh = tessellate_one(surface, close_view(), {2, 8});
  EXPECT_EQ(std::count(mesh.faces.begin(), mesh.faces.end(), 4u), 0);
  EXPECT_EQ(count_edges(mesh).euler, 0);  // an annulus
  expect_on_surface(mesh, surface);
}

TEST(Tessellation, NormalsAreAveragedAcrossSharpEdges) {
  ControlMesh cage = cube_cage();
  for (size_t f = 0; f < 6; ++f) {
    for (size_t i = 0; i < 4; ++i) {
      cage.creases.push_back({cage.face_vertices[f * 4 + i], cage.face_vertices[f * 4 + (i + 1) % 4], 10});
    }
  }
  const SkinMesh mesh = tessellate_one(surface_of(cage), close_view(), {8, 8});
  EXPECT_EQ(count_edges(mesh).not_twice, 0u);
  size_t corners = 0, edges = 0;
  for (size_t v = 0; v < mesh.vertex_count(); ++v) {
    const V3f p = mesh.position(v), n = mesh.normal(v);
    V3f expected(0);
    int on = 0;
    for (int axis = 0; axis < 3; ++axis) {
      if (std::abs(p[axis]) > 1 - 1e-5f) expected[axis] = p[axis] > 0 ? 1.0f : -1.0f, ++on;
    }
    corners += on == 3;
    edges += on == 2;
    EXPECT_LT((n - expected.normalized()).length(), 1e-4f) << p;
  }
  EXPECT_EQ(corners, 8u);
  EXPECT_GT(edges, 12u);
}

TEST(Tessellation, MotionKeysShareTrianglesAndThreadsChangeNothing) {
  const ControlMesh cage = prism_cage(5);
  std::vector<V3f> moved = cage.positions;
  for (V3f& p : moved) p += V3f(0.1f * p.y, 0, 0.2f);
  const LimitSurface first = surface_of(cage);
  const std::vector<LimitSurface> keys{first, LimitSurface(first.shared_topology(), moved)};
  const SkinMesh one = tessellate(keys, close_view(), {1, 16}, Workers(1));
  const SkinMesh four = tessellate(keys, close_view(), {1, 16}, Workers(4));
  EXPECT_EQ(one.positions, four.positions);
  EXPECT_EQ(one.normals, four.normals);
  EXPECT_EQ(one.triangles, four.triangles);
  EXPECT_EQ(one.faces, four.faces);
  ASSERT_EQ(one.motion_keys, 2);
  ASSERT_EQ(one.positions.size(), one.vertex_count() * 6);
  for (size_t t = 0; t < one.triangle_count(); ++t) {
    const V2f uv = one.vertex_uv[t * 3];
    const V3f expected = keys[1].evaluate(one.faces[t], uv.x, uv.y).position;
    ASSERT_LT((one.position(one.triangles[t * 3], 1) - expected).length(), 1e-4f);
  }
}

TEST(Tessellation, OneTriangleCanBeCopiedOut) {
  const ControlMesh cage = prism_cage(5);
  std::vector<V3f> moved = cage.positions;
  for (V3f& p : moved) p += V3f(0, 0.1f * p.x, 0);
  const LimitSurface first = surface_of(cage);
  const std::vector<LimitSurface> keys{first, LimitSurface(first.shared_topology(), moved)};
  const SkinMesh mesh = tessellate(keys, close_view(), {1, 4}, Workers(1));
  SkinMesh one;
  for (size_t t = 0; t < mesh.triangle_count(); t += 7) {
    one.assign_triangle(mesh, t);
    ASSERT_EQ(one.triangle_count(), 1u);
    EXPECT_EQ(one.faces[0], mesh.faces[t]);
    for (uint32_t c = 0; c < 3; ++c) {
      EXPECT_EQ(one.vertex_uv[c], mesh.vertex_uv[3 * t + c]);
      for (int key = 0; key < 2; ++key) {
        EXPECT_EQ(one.position(one.triangles[c], key), mesh.position(mesh.triangles[3 * t + c], key));
        EXPECT_EQ(one.normal(one.triangles[c], key), mesh.normal(mesh.triangles[3 * t + c], key));
      }
    }
  }
}

TEST(Tessellation, RealCages) {
  PELAGE_REQUIRE_DATA();
  for (const char* name : {"spot_control_mesh.obj", "penguin_control_mesh.obj", "sintel_bust.obj"}) {
    SCOPED_TRACE(name);
    const ControlMesh cage = read_obj(data_folder() / "mesh" / name);
    const LimitSurface surface = surface_of(cage);
    View view;
    view.position =
        surface.control_bounds().center() + V3f(0, 0, 3) * surface.control_bounds().size().length();
    view.focal_pixels = 400;
    const SkinMesh mesh = tessellate_one(surface, view, {4, 32});
    const EdgeCount count = count_edges(mesh);
    EXPECT_EQ(count.euler, cage_euler(cage));
    if (std::string(name) != "sintel_bust.obj") {
      EXPECT_EQ(count.not_twice, 0u);
    }
  }
}

}  // namespace
}  // namespace pelage
