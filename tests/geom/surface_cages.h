// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <vector>

#include <gtest/gtest.h>

#include "base/hash.h"
#include "geom/limit_surface.h"
#include "tests/geom/cages.h"

namespace pelage {

inline constexpr auto kCatmull = SubdivisionScheme::kCatmullClark;
inline constexpr auto kCorners = BoundaryRule::kEdgeAndCorner;

inline LimitSurface surface_of(const ControlMesh& cage, SubdivisionScheme scheme = kCatmull,
                               BoundaryRule rule = kCorners) {
  return LimitSurface(SurfaceTopology::create(cage, scheme, rule, "test"), cage.positions);
}

/// Shaken, so that nothing holds by symmetry alone.
inline ControlMesh shaken(ControlMesh cage, float amount = 0.15f) {
  for (size_t i = 0; i < cage.positions.size(); ++i) {
    cage.positions[i] +=
        V3f(signed_float(hash64(i, 1)), signed_float(hash64(i, 2)), signed_float(hash64(i, 3))) * amount;
  }
  return cage;
}

inline ControlMesh with_creases(ControlMesh cage) {
  cage.creases = {{cage.face_vertices[0], cage.face_vertices[1], 2.0f},
                  {cage.face_vertices[1], cage.face_vertices[2], 10.0f},
                  {cage.face_vertices[2], cage.face_vertices[3], 0.7f}};
  cage.corners = {{cage.face_vertices[5], 1.5f}, {cage.face_vertices[7], 10.0f}};
  return cage;
}

struct CageCase {
  const char* name;
  ControlMesh cage;
  SubdivisionScheme scheme = kCatmull;
  BoundaryRule rule = kCorners;
  uint32_t valence = 5;  // at most
};

inline std::vector<CageCase> all_cages() {
  ControlMesh chaikin = with_creases(shaken(torus_cage(6, 5)));
  chaikin.chaikin_creases = true;
  ControlMesh smooth = shaken(poles_cage(6));
  smooth.smooth_triangles = true;
  return {{"cube", cube_cage()},
          {"shaken cube", shaken(cube_cage())},
          {"creased cube", with_creases(shaken(cube_cage()))},
          {"torus", shaken(torus_cage(7, 5))},
          {"creased torus", with_creases(shaken(torus_cage(7, 5)))},
          {"chaikin torus", chaikin},
          {"pentagons", shaken(prism_cage(5))},
          {"triangles", shaken(prism_cage(3))},
          {"polygon of 40", prism_cage(40), kCatmull, kCorners, 40},
          {"poles", shaken(poles_cage(9)), kCatmull, kCorners, 9},
          {"smooth triangles", smooth, kCatmull, kCorners, 6},
          {"border", shaken(grid_cage(3, 2)), kCatmull, kCorners},
          {"round border", shaken(grid_cage(3, 2)), kCatmull, BoundaryRule::kEdgeOnly},
          {"loop", shaken(octahedron_cage(), 0.1f), SubdivisionScheme::kLoop},
          {"bilinear", shaken(prism_cage(5)), SubdivisionScheme::kBilinear}};
}

inline void expect_frame(const Frame& f) {
  EXPECT_NEAR(f.normal.length(), 1, 1e-5);
  EXPECT_NEAR(f.tangent.length(), 1, 1e-5);
  EXPECT_LT((f.bitangent - f.normal.cross(f.tangent)).length(), 1e-5);
  EXPECT_NEAR(f.normal.dot(f.tangent), 0, 1e-5);
}

}  // namespace pelage
