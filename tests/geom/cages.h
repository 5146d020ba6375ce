// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cmath>
#include <vector>

#include "geom/mesh.h"

// Small cages that tests make for themselves.

namespace pelage {

inline ControlMesh make_cage(std::vector<V3f> positions, const std::vector<std::vector<uint32_t>>& faces) {
  ControlMesh mesh;
  mesh.positions = std::move(positions);
  for (const std::vector<uint32_t>& face : faces) {
    mesh.face_sizes.push_back(static_cast<uint32_t>(face.size()));
    mesh.face_vertices.insert(mesh.face_vertices.end(), face.begin(), face.end());
  }
  mesh.face_groups.resize(faces.size());
  mesh.groups = {"default"};
  return mesh;
}

/// Six quads around the origin, corners at +-1.
inline ControlMesh cube_cage() {
  std::vector<V3f> p;
  for (int i = 0; i < 8; ++i)
    p.emplace_back(i & 1 ? 1.0f : -1.0f, i & 2 ? 1.0f : -1.0f, i & 4 ? 1.0f : -1.0f);
  return make_cage(p, {{0, 2, 3, 1}, {4, 5, 7, 6}, {0, 1, 5, 4}, {2, 6, 7, 3}, {0, 4, 6, 2}, {1, 3, 7, 5}});
}

/// A prism over a polygon of n corners: two n-gons and n quads.
inline ControlMesh prism_cage(uint32_t n) {
  std::vector<V3f> p;
  std::vector<std::vector<uint32_t>> faces(2);
  for (uint32_t i = 0; i < 2 * n; ++i) {
    const float angle = 2 * float(M_PI) * static_cast<float>(i % n) / static_cast<float>(n);
    p.emplace_back(std::cos(angle), std::sin(angle), i < n ? -1.0f : 1.0f);
    faces[i / n].push_back(i < n ? n - 1 - i : i);
  }
  for (uint32_t i = 0; i < n; ++i) faces.push_back({i, (i + 1) % n, n + (i + 1) % n, n + i});
  return make_cage(p, faces);
}

/// Regular everywhere: nu x nv quads around a ring of radius 2, tube of radius 1.
inline ControlMesh torus_cage(uint32_t nu, uint32_t nv) {
  std::vector<V3f> p;
  std::vector<std::vector<uint32_t>> faces;
  for (uint32_t i = 0; i < nu; ++i) {
    for (uint32_t j = 0; j < nv; ++j) {
      const float a = 2 * float(M_PI) * static_cast<float>(i) / static_cast<float>(nu);
      const float b = 2 * float(M_PI) * static_cast<float>(j) / static_cast<float>(nv);
      const float r = 2 + std::cos(b);
      p.emplace_back(r * std::cos(a), r * std::sin(a), std::sin(b));
      const uint32_t i2 = (i + 1) % nu, j2 = (j + 1) % nv;
      faces.push_back({i * nv + j, i2 * nv + j, i2 * nv + j2, i * nv + j2});
    }
  }
  return make_cage(p, faces);
}

/// nx x ny unit quads in the plane z = 0, with texture coordinates from 0 to 1; it has a border.
inline ControlMesh grid_cage(uint32_t nx, uint32_t ny) {
  ControlMesh mesh;
  std::vector<V3f> p;
  std::vector<std::vector<uint32_t>> faces;
  std::vector<V2f> uv;
  for (uint32_t y = 0; y <= ny; ++y) {
    for (uint32_t x = 0; x <= nx; ++x) {
      p.emplace_back(static_cast<float>(x), static_cast<float>(y), 0.0f);
      uv.emplace_back(static_cast<float>(x) / static_cast<float>(nx),
                      static_cast<float>(y) / static_cast<float>(ny));
      const uint32_t i = y * (nx + 1) + x;
      if (x < nx && y < ny) faces.push_back({i, i + 1, i + nx + 2, i + nx + 1});
    }
  }
  mesh = make_cage(p, faces);
  mesh.uv = uv;
  mesh.face_uv = mesh.face_vertices;
  return mesh;
}

/// A dense mesh as scans are: 2 n (n - 1) triangles of a bumpy sphere, six around most vertices.
inline float bump(const V3f& direction) {
  return 1 +
         0.05f * std::sin(9 * direction.x) * std::sin(8 * direction.y + 1) * std::sin(7 * direction.z + 2);
}
inline ControlMesh bumpy_sphere(uint32_t n) {
  std::vector<V3f> p{{0, 0, 1}};
  for (uint32_t row = 1; row < n; ++row) {
    for (uint32_t i = 0; i < n; ++i) {
      const double down = M_PI * row / n, around = 2 * M_PI * (i + 0.5 * row) / n;
      p.emplace_back(
          V3d(std::sin(down) * std::cos(around), std::sin(down) * std::sin(around), std::cos(down)));
    }
  }
  p.emplace_back(0.0f, 0.0f, -1.0f);
  for (V3f& position : p) position *= bump(position);
  std::vector<std::vector<uint32_t>> faces;
  const auto at = [&](uint32_t row, uint32_t i) { return 1 + (row - 1) * n + i % n; };
  for (uint32_t i = 0; i < n; ++i) {
    faces.push_back({0, at(1, i), at(1, i + 1)});
    for (uint32_t row = 1; row + 1 < n; ++row) {
      faces.push_back({at(row, i), at(row + 1, i), at(row, i + 1)});
      faces.push_back({at(row, i + 1), at(row + 1, i), at(row + 1, i + 1)});
    }
    faces.push_back({at(n - 1, i), static_cast<uint32_t>(p.size() - 1), at(n - 1, i + 1)});
  }
  return make_cage(p, faces);
}
/// Of the surface that bumpy_sphere() lies on, by differences.
inline V3f bumpy_normal(const V3f& position) {
  const V3d out = V3d(position).normalized();
  V3d gradient = out;
  const auto value = [](V3d at) {
    const V3d d = at.normalized();
    return 0.05 * std::sin(9 * d.x) * std::sin(8 * d.y + 1) * std::sin(7 * d.z + 2);
  };
  for (int axis = 0; axis < 3; ++axis) {
    V3d a = out, b = out;
    a[axis] += 1e-5;
    b[axis] -= 1e-5;
    gradient[axis] -= (value(a) - value(b)) / 2e-5 / (1 + value(out));
  }
  return V3f(gradient.normalized());
}

/// Eight triangles around the origin.
inline ControlMesh octahedron_cage() {
  return make_cage({{1, 0, 0}, {-1, 0, 0}, {0, 1, 0}, {0, -1, 0}, {0, 0, 1}, {0, 0, -1}},
                   {{0, 2, 4}, {2, 1, 4}, {1, 3, 4}, {3, 0, 4}, {2, 0, 5}, {1, 2, 5}, {3, 1, 5}, {0, 3, 5}});
}

/// Two poles of valence n joined by a belt of n quads: 2 n triangles and n quads, closed.
inline ControlMesh poles_cage(uint32_t n) {
  std::vector<V3f> p{{0, 0, -1.5f}, {0, 0, 1.5f}};
  std::vector<std::vector<uint32_t>> faces;
  for (uint32_t i = 0; i < n; ++i) {
    const float angle = 2 * float(M_PI) * static_cast<float>(i) / static_cast<float>(n);
    p.emplace_back(std::cos(angle), std::sin(angle), -0.5f);
    p.emplace_back(std::cos(angle), std::sin(angle), 0.5f);
    const uint32_t a = 2 + 2 * i, b = 2 + 2 * ((i + 1) % n);
    faces.push_back({0, b, a});
    faces.push_back({1, a + 1, b + 1});
    faces.push_back({a, b, b + 1, a + 1});
  }
  return make_cage(p, faces);
}

}  // namespace pelage
