// SPDX-License-Identifier: Apache-2.0
#include "geom/limit_surface.h"

#include <functional>

#include <gtest/gtest.h>

#include "base/error.h"
#include "base/hash.h"
#include "tests/geom/far_oracle.h"
#include "tests/geom/surface_cages.h"

namespace pelage::limit_surface_test {
namespace {

TEST(LimitSurface, EqualsTheLimitOfUniformRefinement) {
  for (const CageCase& c : all_cages()) {
    SCOPED_TRACE(c.name);
    const LimitSurface surface = surface_of(c.cage, c.scheme, c.rule);
    const double size = surface.control_bounds().size().length();
    for (int levels : {1, 3}) {
      if (levels == 1 && !c.cage.creases.empty()) continue;  // not smooth yet, so that there are no masks
      for (const LimitVertex& vertex : uniform_limit(c.cage, c.scheme, c.rule, levels)) {
        const SurfacePoint p = surface.evaluate(vertex.face, vertex.u, vertex.v);
        ASSERT_LT((V3d(p.position) - vertex.position).length(), 1e-6 * size)
            << "face " << vertex.face << " at " << vertex.u << " " << vertex.v << " level " << levels;
      }
    }
    if (!c.cage.creases.empty()) continue;  // where normals jump, there is no distance along them
    // Between the corners of the last patches, a Gregory patch approximates the limit.
    for (const LimitVertex& vertex : uniform_limit(c.cage, c.scheme, c.rule, 5)) {
      const SurfacePoint p = surface.evaluate(vertex.face, vertex.u, vertex.v);
      const V3d off = V3d(p.position) - vertex.position;
      ASSERT_LT(std::abs(off.dot(vertex.normal.normalized())), (c.valence > 5 ? 1e-3 : 1e-4) * size);
    }
  }
}

TEST(LimitSurface, NormalsEqualTheLimitOfUniformRefinement) {
  for (const CageCase& c : all_cages()) {
    // On sharp edges each face has its own normal, and bilinear faces have no other.
    if (!c.cage.creases.empty() || c.scheme == SubdivisionScheme::kBilinear) continue;
    SCOPED_TRACE(c.name);
    const LimitSurface surface = surface_of(c.cage, c.scheme, c.rule);
    for (const LimitVertex& vertex : uniform_limit(c.cage, c.scheme, c.rule, 3)) {
      const bool at_corner = (vertex.u == 0 || vertex.u == 1) && (vertex.v == 0 || vertex.v == 1);
      // At a rounded corner of the border u and v run along one line, and there is no normal to speak of.
      if (at_corner && c.rule == BoundaryRule::kEdgeOnly) continue;
      const Frame frame = surface.frame(vertex.face, vertex.u, vertex.v);
      const double tolerance = at_corner ? 4e-3 : 1e-4;
      ASSERT_LT(angle_between(V3d(frame.normal), vertex.normal), tolerance)
          << "face " << vertex.face << " at " << vertex.u << " " << vertex.v;
    }
  }
}

// Fewer levels isolate the extraordinary vertices of dense cages: what that loses is measured by the size of
// the cage, as a picture shows it.
TEST(LimitSurface, DenseCagesStayNearTheLimit) {
  for (const uint32_t n : {56u, 102u}) {
    const ControlMesh cage = bumpy_sphere(n);
    ASSERT_GT(cage.face_count(), n == 56 ? 6000u : SurfaceTopology::kDenseFaces);
    const LimitSurface surface = surface_of(cage);
    const double size = surface.control_bounds().size().length();
    double max = 0, max_angle = 0;
    for (const LimitVertex& vertex : uniform_limit(cage, kCatmull, kCorners, n == 56 ? 3 : 2)) {
      const Frame frame = surface.frame(vertex.face, vertex.u, vertex.v);
      const V3d off = V3d(surface.evaluate(vertex.face, vertex.u, vertex.v).position) - vertex.position;
      max = std::max(max, std::abs(off.dot(vertex.normal.normalized())));
      max_angle = std::max(max_angle, angle_between(V3d(frame.normal), vertex.normal));
    }
    EXPECT_LT(max, 1e-5 * size) << n;
    EXPECT_LT(max_angle, 1e-2) << n;
  }
}

TEST(LimitSurface, RegularPartsAreBicubicBSplines) {
  const uint32_t nu = 7, nv = 5;
  const ControlMesh cage = shaken(torus_cage(nu, nv));
  const LimitSurface surface = surface_of(cage);
  const auto basis = [](double t, double b[4], double d[4]) {
    b[0] = (1 - t) * (1 - t) * (1 - t) / 6, b[3] = t * t * t / 6;
    b[1] = 2.0 / 3 - t * t * (2 - t) / 2, b[2] = 1 - b[0] - b[1] - b[3];
    d[0] = -(1 - t) * (1 - t) / 2, d[3] = t * t / 2;
    d[1] = t * (3 * t - 4) / 2, d[2] = -d[0] - d[1] - d[3];
  };
  for (uint64_t k = 0; k < 500; ++k) {
    const uint32_t face = static_cast<uint32_t>(hash64(k, 4) % (nu * nv)), i = face / nv, j = face % nv;
    const float u = unit_float(hash64(k, 5)), v = unit_float(hash64(k, 6));
    double bu[4], bv[4], du[4], dv[4];
    basis(u, bu, du);
    basis(v, bv, dv);
    V3d p(0), pu(0), pv(0);
    for (uint32_t a = 0; a < 4; ++a) {
      for (uint32_t b = 0; b < 4; ++b) {
        const V3d q(cage.positions[(i + a + nu - 1) % nu * nv + (j + b + nv - 1) % nv]);
        p += bu[a] * bv[b] * q, pu += du[a] * bv[b] * q, pv += bu[a] * dv[b] * q;
      }
    }
    const SurfacePoint s = surface.evaluate(face, u, v);
    EXPECT_LT((V3d(s.position) - p).length(), 2e-6);
    EXPECT_LT((V3d(s.du) - pu).length(), 5e-6);
    EXPECT_LT((V3d(s.dv) - pv).length(), 5e-6);
  }
}

TEST(LimitSurface, DerivativesAreSlopes) {
  for (const CageCase& c : all_cages()) {
    SCOPED_TRACE(c.name);
    const LimitSurface surface = surface_of(c.cage, c.scheme, c.rule);
    for (uint64_t k = 0; k < 200; ++k) {
      const auto face = static_cast<uint32_t>(hash64(k, 7) % surface.topology().face_count());
      // Off the borders between patches, where there may be a kink.
      const float u = 0.26f + 0.1f * unit_float(hash64(k, 8)), v = 0.26f + 0.1f * unit_float(hash64(k, 9)),
                  h = 2e-3f;
      const SurfacePoint p = surface.evaluate(face, u, v);
      const V3f du =
          (surface.evaluate(face, u + h, v).position - surface.evaluate(face, u - h, v).position) / (2 * h);
      const V3f dv =
          (surface.evaluate(face, u, v + h).position - surface.evaluate(face, u, v - h).position) / (2 * h);
      EXPECT_LT((p.du - du).length(), 2e-3f * (0.1f + du.length()));
      EXPECT_LT((p.dv - dv).length(), 2e-3f * (0.1f + dv.length()));
    }
  }
}

TEST(LimitSurface, NeighboursMeet) {
  for (const CageCase& c : all_cages()) {
    SCOPED_TRACE(c.name);
    const LimitSurface surface = surface_of(c.cage, c.scheme, c.rule);
    const SurfaceTopology& topology = surface.topology();
    const int sides = c.scheme == SubdivisionScheme::kLoop ? 3 : 4;
    const auto along = [&](int side, float t) {
      if (sides == 3) return side == 0 ? V2f(t, 0) : side == 1 ? V2f(1 - t, t) : V2f(0, 1 - t);
      return side == 0 ? V2f(t, 0) : side == 1 ? V2f(1, t) : side == 2 ? V2f(1 - t, 1) : V2f(0, 1 - t);
    };
    // Whether a ptex face is a part of a cage face: those are joined to whole ones by halves of edges.
    const auto is_part = [&](uint32_t face) {
      return c.cage.face_sizes[topology.cage_face(face)] != uint32_t(sides);
    };
    size_t joints = 0;
    for (uint32_t face = 0; face < topology.face_count(); ++face) {
      for (int side = 0; side < sides; ++side) {
        const int other = topology.neighbour(face, side);
        if (other < 0) continue;
        int back = 0;
        while (back < sides &&
               topology.neighbour(static_cast<uint32_t>(other), back) != static_cast<int>(face))
          ++back;
        if (is_part(face) != is_part(static_cast<uint32_t>(other))) continue;
        ASSERT_LT(back, sides) << face << " knows " << other << ", which does not know it";
        for (float t : {0.0f, 0.3f, 0.77f, 1.0f}) {
          const V2f here = along(side, t), there = along(back, 1 - t);
          const SurfacePoint a = surface.evaluate(face, here.x, here.y);
          const SurfacePoint b = surface.evaluate(static_cast<uint32_t>(other), there.x, there.y);
          ASSERT_LT((a.position - b.position).length(), 3e-6f)
              << face << " " << side << " to " << other << " " << back;
        }
        ++joints;
      }
    }
    EXPECT_GT(joints, 4u);
  }
}

TEST(LimitSurface, FramesAreOrthonormalEverywhere) {
  std::vector<CageCase> cages = all_cages();
  ControlMesh collapsed = cube_cage();
  for (int i : {0, 1, 2, 3}) collapsed.positions[static_cast<size_t>(i)] = V3f(0, 0, -1);
  ControlMesh point = cube_cage(), line = cube_cage(), huge = cube_cage(), tiny = cube_cage();
  for (V3f& p : point.positions) p = V3f(3, 4, 5);
  for (V3f& p : line.positions) p = V3f(p.x, 0, 0);
  for (V3f& p : huge.positions) p *= 1e18f;
  for (V3f& p : tiny.positions) p *= 1e-25f;
  ControlMesh degenerate_quads = make_cage({{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {0, 0, 1}},
                                           {{0, 2, 1, 1}, {0, 1, 3, 3}, {1, 2, 3, 3}, {2, 0, 3, 3}});
  for (auto& [name, cage] : {std::pair("a face at a point", collapsed),
                             {"all at a point", point},
                             {"a line", line},
                             {"huge", huge},
                             {"tiny", tiny},
                             {"corners twice", degenerate_quads},
                             {"poles of 360", poles_cage(360)}}) {
    cages.push_back({name, cage});
  }
  for (const CageCase& c : cages) {
    SCOPED_TRACE(c.name);
    const LimitSurface surface = surface_of(c.cage, c.scheme, c.rule);
    const uint32_t step = std::max(1u, surface.topology().face_count() / 40);
    for (uint32_t face = 0; face < surface.topology().face_count(); face += step) {
      for (float u : {0.0f, 1e-7f, 0.3f, 0.5f, 1.0f}) {
        for (float v : {0.0f, 0.25f, 0.999999f, 1.0f}) expect_frame(surface.frame(face, u, v));
      }
    }
  }
  // Size and place change no frame.
  EXPECT_LT(
      (surface_of(huge).frame(2, 0.2f, 0.7f).normal - surface_of(cube_cage()).frame(2, 0.2f, 0.7f).normal)
          .length(),
      1e-5f);
  EXPECT_LT(
      (surface_of(tiny).frame(2, 0.2f, 0.7f).normal - surface_of(cube_cage()).frame(2, 0.2f, 0.7f).normal)
          .length(),
      1e-5f);
  expect_frame(LimitSurface::frame_of({V3f(0), V3f(0), V3f(0)}));
  expect_frame(LimitSurface::frame_of({V3f(0), V3f(0, 2, 0), V3f(0, 4, 0)}));
  expect_frame(LimitSurface::frame_of({V3f(0), V3f(0), V3f(0, 4, 0)}));
}

TEST(LimitSurface, OutwardNormals) {
  const LimitSurface cube = surface_of(cube_cage());
  for (uint32_t face = 0; face < 6; ++face) {
    const SurfacePoint p = cube.evaluate(face, 0.4f, 0.7f);
    EXPECT_GT(cube.frame(face, 0.4f, 0.7f).normal.dot(p.position), 0);
    // At the corner of valence 3, by symmetry.
    const V3f corner = cube.evaluate(face, 0, 0).position;
    EXPECT_LT((cube.frame(face, 0, 0).normal - corner.normalized()).length(), 1e-5f);
  }
}

TEST(LimitSurface, ParametersOutsideTheFaceAreMovedToItsBorder) {
  const LimitSurface quads = surface_of(cube_cage()),
                     triangles = surface_of(octahedron_cage(), SubdivisionScheme::kLoop);
  EXPECT_EQ(quads.evaluate(1, -3, 0.5f).position, quads.evaluate(1, 0, 0.5f).position);
  EXPECT_EQ(quads.evaluate(1, 0.5f, 7).position, quads.evaluate(1, 0.5f, 1).position);
  EXPECT_EQ(quads.evaluate(1, NAN, 0.5f).position, quads.evaluate(1, 0, 0.5f).position);
  EXPECT_LT((triangles.evaluate(1, 3, 3).position - triangles.evaluate(1, 0.5f, 0.5f).position).length(),
            1e-6f);
}

TEST(LimitSurface, FarFromTheOriginNothingIsLost) {
  ControlMesh cage = shaken(prism_cage(5));
  const V3f away(1024, -512, 2048);
  // Positions that can be moved without rounding.
  for (V3f& p : cage.positions) p = (p + away) - away;
  ControlMesh moved = cage;
  for (V3f& p : moved.positions) p += away;
  const LimitSurface near = surface_of(cage), far = surface_of(moved);
  for (uint64_t k = 0; k < 300; ++k) {
    const auto face = static_cast<uint32_t>(hash64(k, 1) % near.topology().face_count());
    const float u = unit_float(hash64(k, 2)), v = unit_float(hash64(k, 3));
    EXPECT_LT(angle_between(V3d(near.frame(face, u, v).normal), V3d(far.frame(face, u, v).normal)), 2e-5);
    EXPECT_LT((near.evaluate(face, u, v).position + away - far.evaluate(face, u, v).position).length(),
              2e-4f);
  }
}

TEST(LimitSurface, APartIsTheSameBitByBit) {
  for (const CageCase& c : all_cages()) {
    SCOPED_TRACE(c.name);
    const LimitSurface whole = surface_of(c.cage, c.scheme, c.rule);
    const uint32_t count = whole.topology().face_count();
    for (uint64_t round = 0; round < 4; ++round) {
      std::vector<uint32_t> faces;
      for (uint32_t f = 0; f < count; ++f) {
        if (hash64(f, round) % 4 <= round) faces.push_back(count - 1 - f);
      }
      const LimitSurface part(whole.shared_topology(), c.cage.positions, faces);
      const SurfaceTopology::PoseBytes bytes = whole.topology().pose_bytes(faces);
      EXPECT_LE(part.bytes(), bytes.held + bytes.making);
      EXPECT_LE(faces.size() < count ? part.bytes() : 0, whole.bytes() + whole.bytes() / 4 + 256);
      for (uint32_t face : faces) {
        for (uint64_t i = 0; i < 8; ++i) {
          const float u = unit_float(hash64(face, i, 1)), v = unit_float(hash64(face, i, 2));
          const SurfacePoint a = whole.evaluate(face, u, v), b = part.evaluate(face, u, v);
          EXPECT_EQ(a.position, b.position);
          EXPECT_EQ(a.du, b.du);
          EXPECT_EQ(a.dv, b.dv);
          EXPECT_EQ(whole.frame(face, u, v).normal, part.frame(face, u, v).normal);
        }
      }
    }
  }
}

TEST(LimitSurface, APartCostsWhatItsFacesCost) {
  const ControlMesh cage = shaken(torus_cage(60, 40));
  const auto topology = SurfaceTopology::create(cage, kCatmull, kCorners, "test");
  const uint32_t faces[] = {0, 1, 2, 40, 41, 42};
  const auto part = topology->pose_bytes(faces), whole = topology->pose_bytes();
  EXPECT_LT(part.held, whole.held / 5);
  EXPECT_LT(part.making, whole.making / 5);
  EXPECT_EQ(LimitSurface(topology, cage.positions, faces).bytes(), part.held);
  EXPECT_EQ(LimitSurface(topology, cage.positions).bytes(), whole.held);
}

}  // namespace
}  // namespace pelage::limit_surface_test
