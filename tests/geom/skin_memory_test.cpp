// SPDX-License-Identifier: Apache-2.0
#include "geom/skin_memory.h"

#include <map>

#include <gtest/gtest.h>

#include "base/hash.h"
#include "base/parallel.h"
#include "geom/closest_point.h"
#include "geom/io/obj_file.h"
#include "geom/tessellation.h"
#include "tests/geom/cages.h"
#include "tests/support/allocation_meter.h"
#include "tests/support/data.h"

namespace pelage::skin_memory_test {
namespace {

struct Case {
  const char* name;
  ControlMesh mesh;
  SubdivisionScheme scheme = SubdivisionScheme::kCatmullClark;
  double over = 2;  // how many times more than is measured an estimate may be
};

void expect_bounded(const Case& c) {
  SCOPED_TRACE(c.name);
  const SkinMemory estimate = skin_memory(c.mesh, c.scheme);
  const auto peak = [&](size_t measured) {
    return static_cast<size_t>(c.over * static_cast<double>(measured)) + (1 << 17);
  };
  reset_peak();
  const size_t before = live_bytes();
  const auto topology = SurfaceTopology::create(c.mesh, c.scheme, BoundaryRule::kEdgeAndCorner, "test");
  EXPECT_LE(peak_bytes() - before, estimate.making);
  EXPECT_GE(peak(peak_bytes() - before), estimate.making);
  const LimitSurface surface(topology, c.mesh.positions);
  const size_t held = live_bytes() - before;
  EXPECT_LE(held, estimate.held);
  EXPECT_GE(peak(held), estimate.held);
  reset_peak();
  View far;
  far.focal_pixels = 1e-3f;  // so that no edge is divided
  const SkinMesh skin = tessellate(std::span(&surface, 1), far, {}, Workers(1));
  const ClosestPointTree tree(skin, 0);
  EXPECT_LE(peak_bytes() - before - held, estimate.triangles);
  EXPECT_GE(peak(peak_bytes() - before - held), estimate.triangles);
  EXPECT_GE(estimate.peak(), std::max(estimate.making, held));
}

TEST(SkinMemory, IsBoundedBeforeAnythingIsMade) {
  ControlMesh creased = torus_cage(40, 30), semi_sharp = torus_cage(40, 30), sharp = torus_cage(40, 30);
  for (uint32_t i = 0; i < 100; ++i) {
    const uint32_t a = creased.face_vertices[4 * i], b = creased.face_vertices[4 * i + 1];
    creased.creases.push_back({a, b, 2.5f});
    semi_sharp.creases.push_back({a, b, 5.5f});
    sharp.creases.push_back({a, b, 10.0f});
  }
  ControlMesh mapped = bumpy_sphere(60);
  mapped.uv.resize(mapped.positions.size());
  mapped.face_uv = mapped.face_vertices;
  using S = SubdivisionScheme;
  for (const Case& c : {Case{"triangles", bumpy_sphere(30)},
                        {"dense triangles", bumpy_sphere(56)},
                        {"very dense triangles", bumpy_sphere(102)},
                        {"quads", torus_cage(40, 30), S::kCatmullClark, 3},
                        {"dense quads", torus_cage(90, 80), S::kCatmullClark, 3},
                        {"quads with a border", grid_cage(40, 40), S::kCatmullClark, 3},
                        {"poles", poles_cage(300)},
                        {"polygons", prism_cage(300)},
                        {"creases", creased, S::kCatmullClark, 3},
                        {"semi-sharp creases", semi_sharp, S::kCatmullClark, 3},
                        {"sharp creases", sharp, S::kCatmullClark, 3},
                        {"loop", bumpy_sphere(30), S::kLoop},
                        {"dense loop", bumpy_sphere(56), S::kLoop},
                        {"very dense loop", bumpy_sphere(102), S::kLoop},
                        {"bilinear triangles", bumpy_sphere(40), S::kBilinear},
                        {"bilinear quads", torus_cage(40, 30), S::kBilinear},
                        {"flat", bumpy_sphere(102), S::kNone},
                        {"flat, mapped", mapped, S::kNone},
                        {"flat quads", torus_cage(60, 50), S::kNone}}) {
    expect_bounded(c);
  }
}

/// A cage as strangers write them: some squares of a lattice of k^3 cubes, whole or as triangles, some of
/// them turned over or written twice, some vertices without a face, and perhaps a sharp edge.
ControlMesh tangled_cage(uint64_t seed, bool triangles) {
  auto draw = [&, use = uint64_t(0)]() mutable { return unit_float(hash64(seed, ++use)); };
  const uint32_t k = 3 + seed % 3;
  const float share = 0.05f + 0.9f * draw(), turned = seed % 3 ? 0 : 0.3f, twice = seed % 4 ? 0 : 0.5f;
  std::vector<V3f> positions;
  std::vector<std::vector<uint32_t>> faces;
  const uint32_t step[] = {1, k + 1, (k + 1) * (k + 1)};
  for (uint32_t v = 0; v < (k + 1) * step[2]; ++v) {
    const uint32_t at[] = {v % step[1], v % step[2] / step[1], v / step[2]};
    positions.emplace_back(V3f(at[0], at[1], at[2]) + V3f(0.2f * draw(), 0.2f * draw(), 0));
    for (int axis = 0; axis < 3; ++axis) {
      const int other = (axis + 1) % 3;
      if (at[axis] == k || at[other] == k || draw() > share) continue;
      const uint32_t a = v, b = v + step[axis], c = b + step[other], d = v + step[other];
      const bool turn = draw() < turned;
      for (int copy = 0; copy < (draw() < twice ? 2 : 1); ++copy) {
        std::vector<uint32_t> square = turn != (copy > 0) ? std::vector{d, c, b, a} : std::vector{a, b, c, d};
        if (triangles) faces.push_back({square[0], square[2], square[3]});
        if (triangles) square.pop_back();
        faces.push_back(square);
      }
    }
  }
  ControlMesh cage = make_cage(positions, faces);
  if (seed % 5 == 2 && !faces.empty())
    cage.creases.push_back({faces[0][0], faces[0][1], seed % 2 ? 10.0f : 2.5f});
  return cage;
}

TEST(SkinMemory, IsBoundedForWhatIsNoManifold) {
  using S = SubdivisionScheme;
  for (uint64_t seed = 0; seed < 8; ++seed) {
    SCOPED_TRACE(seed);
    for (const S scheme : {S::kCatmullClark, S::kLoop, S::kBilinear, S::kNone})
      expect_bounded({"tangled", tangled_cage(seed, scheme == S::kLoop || seed % 2), scheme, 16});
  }
}

/// Three quads in each triangle, so that most quads have two irregular vertices.
ControlMesh quads_of(const ControlMesh& triangles) {
  std::vector<V3f> positions = triangles.positions;
  std::vector<std::vector<uint32_t>> faces;
  std::map<std::pair<uint32_t, uint32_t>, uint32_t> middles;
  const auto add = [&](const V3f& position) {
    positions.push_back(position);
    return static_cast<uint32_t>(positions.size() - 1);
  };
  const auto middle = [&](uint32_t a, uint32_t b) {
    uint32_t& made = middles[std::minmax(a, b)];
    return made ? made : made = add((positions[a] + positions[b]) * 0.5f);
  };
  for (size_t face = 0; face < triangles.face_count(); ++face) {
    const uint32_t* v = &triangles.face_vertices[3 * face];
    const uint32_t centre = add((positions[v[0]] + positions[v[1]] + positions[v[2]]) / 3.0f);
    for (int i = 0; i < 3; ++i)
      faces.push_back({v[i], middle(v[i], v[(i + 1) % 3]), centre, middle(v[(i + 2) % 3], v[i])});
  }
  return make_cage(positions, faces);
}

TEST(SkinMemory, IsBoundedForIrregularFacesAndLooseVertices) {
  ControlMesh loose = torus_cage(10, 10);
  loose.positions.resize(20000, V3f(1));
  // The diagonals of the quads point either way: all valences from 4 to 8.
  ControlMesh flipped = torus_cage(24, 24);
  std::vector<std::vector<uint32_t>> triangles;
  for (size_t i = 0; i < flipped.face_count(); ++i) {
    const uint32_t* v = &flipped.face_vertices[4 * i];
    const size_t turn = hash64(i) % 2;
    for (const size_t first : {turn, turn + 2})
      triangles.push_back({v[first % 4], v[(first + 1) % 4], v[(first + 2) % 4]});
  }
  flipped = make_cage(flipped.positions, triangles);
  using S = SubdivisionScheme;
  for (const S scheme : {S::kCatmullClark, S::kLoop, S::kBilinear, S::kNone}) {
    expect_bounded({"flipped", flipped, scheme});
    expect_bounded({"quads of triangles", scheme == S::kLoop ? flipped : quads_of(flipped), scheme});
    if (scheme != S::kLoop) expect_bounded({"loose vertices", loose, scheme});
  }
}

/// Many faces along edges that three faces share cost little more than faces around other irregular vertices.
TEST(SkinMemory, NonManifoldEdgesAreNoLuxury) {
  std::vector<V3f> positions;
  std::vector<std::vector<uint32_t>> faces;
  constexpr uint32_t kRows = 700;
  for (uint32_t page = 0; page < 4; ++page) {
    const float angle = 2 * float(M_PI) * static_cast<float>(page) / 3;
    for (uint32_t row = 0; row <= kRows; ++row)
      positions.emplace_back(page ? std::cos(angle) : 0, page ? std::sin(angle) : 0, row);
    for (uint32_t row = 0; page > 0 && row < kRows; ++row) {
      const uint32_t at = page * (kRows + 1) + row;
      faces.push_back({row, at, at + 1, row + 1});
    }
  }
  reset_peak();
  const size_t before = live_bytes();
  SurfaceTopology::create(make_cage(positions, faces), SubdivisionScheme::kCatmullClark,
                          BoundaryRule::kEdgeAndCorner, "test");
  EXPECT_LT(peak_bytes() - before, faces.size() * 30'000) << "455 kB per face, once";
}

TEST(SkinMemory, OfRealCages) {
  PELAGE_REQUIRE_DATA();
  for (const char* name :
       {"penguin_control_mesh.obj", "sintel_bust.obj", "spot_control_mesh.obj", "spot_quadrangulated.obj"}) {
    const ControlMesh mesh = read_obj(data_folder() / "mesh" / name);
    for (const auto scheme : {SubdivisionScheme::kCatmullClark, SubdivisionScheme::kNone})
      expect_bounded({name, mesh, scheme, 3});
  }
}

}  // namespace
}  // namespace pelage::skin_memory_test
