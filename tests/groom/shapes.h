// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cmath>
#include <memory>
#include <vector>

#include "geom/limit_surface.h"
#include "geom/mesh.h"

namespace pelage::shapes {

/// A cage of n x m quads with texture coordinates; `place` maps (u, v) in [0, 1]^2 to a position.
template <class Place>
ControlMesh grid_cage(int n, int m, const Place& place) {
  ControlMesh mesh;
  for (int j = 0; j <= m; ++j) {
    for (int i = 0; i <= n; ++i) {
      const float u = static_cast<float>(i) / static_cast<float>(n),
                  v = static_cast<float>(j) / static_cast<float>(m);
      mesh.positions.push_back(place(u, v));
      mesh.uv.emplace_back(u, v);
    }
  }
  const auto at = [n](int i, int j) { return static_cast<uint32_t>(j * (n + 1) + i); };
  for (int j = 0; j < m; ++j) {
    for (int i = 0; i < n; ++i) {
      mesh.face_sizes.push_back(4);
      for (uint32_t c : {at(i, j), at(i + 1, j), at(i + 1, j + 1), at(i, j + 1)}) {
        mesh.face_vertices.push_back(c);
        mesh.face_uv.push_back(c);
      }
    }
  }
  mesh.face_groups.assign(mesh.face_sizes.size(), 0);
  mesh.groups = {""};
  return mesh;
}

/// The square [0, 1]^2 in the plane z = 0; its limit surface is the square itself, u = x, v = y.
inline ControlMesh square_cage(int n) {
  return grid_cage(n, n, [](float u, float v) { return V3f(u, v, 0); });
}

/// A cube around the origin whose limit surface is a rounded ball of radius about 0.83 times half its side.
inline ControlMesh ball_cage(float half = 1) {
  ControlMesh mesh;
  for (int i = 0; i < 8; ++i) {
    mesh.positions.emplace_back(i & 1 ? half : -half, i & 2 ? half : -half, i & 4 ? half : -half);
  }
  mesh.face_sizes.assign(6, 4);
  mesh.face_vertices = {0, 2, 3, 1, 4, 5, 7, 6, 0, 1, 5, 4, 2, 6, 7, 3, 0, 4, 6, 2, 1, 3, 7, 5};
  mesh.face_groups.assign(6, 0);
  mesh.groups = {""};
  return mesh;
}

inline std::shared_ptr<const SurfaceTopology> topology_of(const ControlMesh& mesh) {
  return SurfaceTopology::create(mesh, SubdivisionScheme::kCatmullClark, BoundaryRule::kEdgeAndCorner,
                                 "test");
}

inline std::shared_ptr<const LimitSurface> surface_of(const ControlMesh& mesh) {
  return std::make_shared<const LimitSurface>(topology_of(mesh), mesh.positions);
}

}  // namespace pelage::shapes
