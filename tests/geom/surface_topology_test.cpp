// SPDX-License-Identifier: Apache-2.0
#include <functional>

#include <gtest/gtest.h>

#include "base/error.h"
#include "base/hash.h"
#include "tests/geom/surface_cages.h"

namespace pelage::surface_topology_test {
namespace {

TEST(SurfaceTopology, PosesShareIt) {
  const ControlMesh cage = shaken(prism_cage(5));
  const auto topology = SurfaceTopology::create(cage, kCatmull, kCorners, "test");
  const LimitSurface rest(topology, cage.positions);
  std::vector<V3f> turned = cage.positions;
  for (V3f& p : turned) p = V3f(-p.y, p.x, p.z + 3);
  const LimitSurface pose(topology, turned);
  EXPECT_EQ(&rest.topology(), &pose.topology());
  for (uint32_t face = 0; face < topology->face_count(); ++face) {
    const V3f p = rest.evaluate(face, 0.3f, 0.6f).position;
    EXPECT_LT((pose.evaluate(face, 0.3f, 0.6f).position - V3f(-p.y, p.x, p.z + 3)).length(), 2e-6f);
  }
  EXPECT_GT(topology->bytes(), 10000u);
  EXPECT_LT(rest.bytes(), topology->bytes());
}

TEST(SurfaceTopology, HashesTellTopologiesApart) {
  const ControlMesh cage = with_creases(grid_cage(3, 3));
  const auto hash_of = [](const ControlMesh& mesh, SubdivisionScheme scheme = kCatmull,
                          BoundaryRule rule = kCorners) {
    return SurfaceTopology::create(mesh, scheme, rule, "test")->hash();
  };
  const ContentHash hash = hash_of(cage);
  ControlMesh moved = shaken(cage);
  moved.groups = {"other"};
  EXPECT_EQ(hash_of(moved), hash);
  const std::function<void(ControlMesh&)> changes[] = {
      [](ControlMesh& m) { m.creases[0].sharpness = 2.1f; },
      [](ControlMesh& m) { m.corners[0].sharpness += 0.1f; },
      [](ControlMesh& m) { m.corners.pop_back(); },
      [](ControlMesh& m) { std::swap(m.creases[0].a, m.creases[0].b); },
      [](ControlMesh& m) { m.holes.push_back(2); },
      [](ControlMesh& m) { m.uv[3].x += 0.5f; },
      [](ControlMesh& m) { m.face_uv[3] = 0; },
      [](ControlMesh& m) { m.chaikin_creases = true; },
      [](ControlMesh& m) { m.smooth_triangles = true; },
      [](ControlMesh& m) { m.positions.emplace_back(0.0f); },
      [](ControlMesh& m) { std::rotate(&m.face_vertices[0], &m.face_vertices[1], &m.face_vertices[4]); }};
  for (const auto& change : changes) {
    ControlMesh changed = cage;
    change(changed);
    EXPECT_FALSE(hash_of(changed) == hash);
  }
  EXPECT_FALSE(hash_of(cage, SubdivisionScheme::kBilinear) == hash);
  EXPECT_FALSE(hash_of(cage, kCatmull, BoundaryRule::kEdgeOnly) == hash);
}

TEST(SurfaceTopology, TextureCoordinates) {
  ControlMesh cage = grid_cage(2, 1);
  const auto quads = SurfaceTopology::create(cage, kCatmull, kCorners, "test");
  EXPECT_LT((quads->texture_coordinates(1, 0.5f, 0.25f) - V2f(0.75f, 0.25f)).length(), 1e-6f);
  // A pentagon whose texture coordinates are its positions: on its ptex faces corner, middles and centre.
  ControlMesh pentagon = prism_cage(5);
  for (const V3f& p : pentagon.positions) pentagon.uv.emplace_back(p.x, p.y);
  pentagon.face_uv = pentagon.face_vertices;
  const auto parts = SurfaceTopology::create(pentagon, kCatmull, kCorners, "test");
  ASSERT_EQ(parts->face_count(), 15u);
  for (uint32_t face = 5; face < 10; ++face) {
    const V2f a = pentagon.uv[pentagon.face_vertices[face]];
    const V2f b = pentagon.uv[pentagon.face_vertices[5 + (face - 4) % 5]];
    EXPECT_EQ(parts->cage_face(face), 1u);
    EXPECT_LT((parts->texture_coordinates(face, 0, 0) - a).length(), 1e-6f);
    EXPECT_LT((parts->texture_coordinates(face, 1, 0) - 0.5f * (a + b)).length(), 1e-6f);
    EXPECT_LT(parts->texture_coordinates(face, 1, 1).length(), 1e-6f);
  }
  cage.uv.clear();
  cage.face_uv.clear();
  EXPECT_EQ(SurfaceTopology::create(cage, kCatmull, kCorners, "test")->texture_coordinates(1, 0.25f, 0.5f),
            V2f(0.25f, 0.5f));
}

TEST(SurfaceTopology, HolesAndBorders) {
  ControlMesh cage = grid_cage(3, 3);
  cage.holes = {4};
  const auto topology = SurfaceTopology::create(cage, kCatmull, kCorners, "test");
  EXPECT_TRUE(topology->is_hole(4));
  EXPECT_FALSE(topology->is_hole(3));
  EXPECT_EQ(topology->neighbour(0, 0), -1);
  EXPECT_EQ(topology->neighbour(0, 1), 1);
  EXPECT_EQ(topology->neighbour(0, 2), 3);
  EXPECT_EQ(topology->neighbour(0, 3), -1);
  EXPECT_EQ(topology->neighbour(3, 1), 4);
  // A hole changes nothing around it.
  const LimitSurface with(topology, cage.positions), without = surface_of(grid_cage(3, 3));
  EXPECT_EQ(with.evaluate(3, 0.9f, 0.5f).position, without.evaluate(3, 0.9f, 0.5f).position);
  // The corner of the border is met, or rounded.
  EXPECT_LT(without.evaluate(0, 0, 0).position.length(), 1e-6f);
  EXPECT_GT(
      surface_of(grid_cage(3, 3), kCatmull, BoundaryRule::kEdgeOnly).evaluate(0, 0, 0).position.length(),
      0.1f);
}

TEST(SurfaceTopology, RefusesWhatHasNoSurface) {
  const auto message = [](const ControlMesh& mesh, SubdivisionScheme scheme = kCatmull) -> std::string {
    try {
      SurfaceTopology::create(mesh, scheme, kCorners, "cage.obj");
    } catch (const Error& error) {
      EXPECT_EQ(error.kind(), ErrorKind::kInput);
      return error.what();
    }
    return "accepted";
  };
  EXPECT_EQ(message(ControlMesh()), "cage.obj: the cage has no faces");
  EXPECT_EQ(message(make_cage({{0, 0, 0}, {1, 0, 0}, {0, 1, 0}}, {{0, 1, 2}, {0, 1}})),
            "cage.obj: face 2 has 2 corners; 3 to 1000 are supported");
  EXPECT_EQ(message(make_cage({{0, 0, 0}, {1, 0, 0}, {0, 1, 0}}, {{0, 1, 2}, {0, 1, 3}, {0, 1, 1}})),
            "cage.obj: face 2 uses vertex 4, but the cage has 3\ncage.obj: face 3 has fewer than 3 different "
            "vertices");
  EXPECT_NE(message(cube_cage(), SubdivisionScheme::kLoop)
                .find("the loop scheme needs triangles, but face 1 has 4 corners; 6 of 6 faces have more"),
            std::string::npos);
  EXPECT_EQ(message(prism_cage(1001)).substr(0, 30), "cage.obj: face 1 has 1001 corn");
  EXPECT_EQ(message(poles_cage(1001)).substr(0, 40), "cage.obj: 1001 faces meet at vertex 1; t");
  // Each allowed by itself, together tens of gigabytes.
  ControlMesh cage;
  for (uint32_t copy = 0; copy < 100; ++copy) {
    const ControlMesh poles = poles_cage(1000);
    const auto first = static_cast<uint32_t>(cage.positions.size());
    cage.positions.insert(cage.positions.end(), poles.positions.begin(), poles.positions.end());
    cage.face_sizes.insert(cage.face_sizes.end(), poles.face_sizes.begin(), poles.face_sizes.end());
    for (uint32_t v : poles.face_vertices) cage.face_vertices.push_back(first + v);
  }
  EXPECT_EQ(message(cage).substr(0, 46), "cage.obj: too many vertices with many faces an");
  cage = cube_cage();
  cage.creases = {{0, 7, 1}};
  EXPECT_EQ(message(cage), "cage.obj: the crease from vertex 1 to 8 is not an edge of any face");
  cage = cube_cage();
  cage.corners = {{8, 1}};
  EXPECT_EQ(message(cage), "cage.obj: corner at vertex 9: this vertex does not exist");
  cage = cube_cage();
  cage.holes = {6};
  EXPECT_EQ(message(cage), "cage.obj: hole 7: this face does not exist");
  cage = cube_cage();
  cage.face_sizes.pop_back();
  EXPECT_EQ(message(cage), "cage.obj: the faces of the cage have 20 corners, but 24 are given");
}

/// Random faces over few vertices: edges of many faces, faces both ways round, vertices twice in a face.
TEST(SurfaceTopology, SurvivesAnyCage) {
  int accepted = 0;
  for (uint64_t trial = 0; trial < 200; ++trial) {
    const uint32_t vertices = 4 + static_cast<uint32_t>(hash64(trial, 1) % 9);
    std::vector<V3f> p;
    for (uint32_t i = 0; i < vertices; ++i) {
      p.emplace_back(signed_float(hash64(trial, i, 2)), signed_float(hash64(trial, i, 3)),
                     signed_float(hash64(trial, i, 4)));
    }
    std::vector<std::vector<uint32_t>> faces(1 + hash64(trial, 5) % 10);
    for (size_t f = 0; f < faces.size(); ++f) {
      for (uint64_t i = 0; i < 3 + hash64(trial, f, 6) % 4; ++i) {
        faces[f].push_back(static_cast<uint32_t>(hash64(trial, f, i, 7) % vertices));
      }
    }
    ControlMesh cage = make_cage(p, faces);
    if (trial % 2) cage.corners = {{cage.face_vertices[0], 3}};
    try {
      const LimitSurface surface = surface_of(cage, trial % 5 == 0   ? SubdivisionScheme::kBilinear
                                                    : trial % 5 == 1 ? SubdivisionScheme::kNone
                                                                     : kCatmull);
      ++accepted;
      for (uint32_t face = 0; face < surface.topology().face_count(); ++face) {
        expect_frame(
            surface.frame(face, unit_float(hash64(trial, face)), unit_float(hash64(trial, face, 1))));
        expect_frame(surface.frame(face, 0, 0));
      }
    } catch (const Error& error) {
      EXPECT_FALSE(error.problems().empty());
    }
  }
  EXPECT_GT(accepted, 20);
}

}  // namespace
}  // namespace pelage::surface_topology_test
