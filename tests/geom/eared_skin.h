// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <algorithm>
#include <cmath>
#include <span>
#include <utility>

#include "base/parallel.h"
#include "geom/tessellation.h"
#include "tests/geom/surface_cages.h"

// Triangle meshes for tests of balls inside skins.

namespace pelage {

/// The faces of a cage as they are.
inline SkinMesh flat_skin(const ControlMesh& cage) {
  const LimitSurface surface = surface_of(cage, SubdivisionScheme::kNone);
  return tessellate(std::span(&surface, 1), View{}, {}, Workers(1));
}

inline SkinMesh sphere_skin(uint32_t rows) {
  ControlMesh cage = bumpy_sphere(rows);
  for (V3f& p : cage.positions) p.normalize();
  return flat_skin(cage);
}

/// A bumpy ball with two thin ears.
inline SkinMesh eared_skin() {
  ControlMesh cage = bumpy_sphere(48);
  for (V3f& p : cage.positions) {
    const V3f d = p.normalized();
    for (const float side : {-0.45f, 0.45f}) {
      const float off = (d.x - side) / 0.06f;
      if (d.y > 0.3f) p += 1.2f * (d.y - 0.3f) * std::exp(-off * off) * V3f(side, 1, 0);
    }
  }
  return flat_skin(cage);
}

inline SkinMesh inside_out(SkinMesh mesh) {
  for (size_t t = 0; t < mesh.triangle_count(); ++t)
    std::swap(mesh.triangles[3 * t], mesh.triangles[3 * t + 1]);
  return mesh;
}

/// Adds another mesh of one motion key, moved by `by`.
inline void append(SkinMesh& mesh, const SkinMesh& other, const V3f& by) {
  const auto first = static_cast<uint32_t>(mesh.vertex_count());
  for (size_t v = 0; v < other.vertex_count(); ++v) {
    const V3f p = other.position(v) + by, n = other.normal(v);
    mesh.positions.insert(mesh.positions.end(), {p.x, p.y, p.z});
    mesh.normals.insert(mesh.normals.end(), {n.x, n.y, n.z});
  }
  for (const uint32_t v : other.triangles) mesh.triangles.push_back(first + v);
  mesh.faces.insert(mesh.faces.end(), other.faces.begin(), other.faces.end());
  mesh.vertex_uv.insert(mesh.vertex_uv.end(), other.vertex_uv.begin(), other.vertex_uv.end());
}

/// The mesh with separate vertices for each triangle, as if all edges were seams of texture coordinates.
inline SkinMesh split_at_edges(const SkinMesh& mesh) {
  SkinMesh split = mesh;
  const auto copy = [&](const std::vector<float>& values, std::vector<float>& copies) {
    copies.clear();
    for (size_t key = 0; key < static_cast<size_t>(mesh.motion_keys); ++key) {
      for (const uint32_t v : mesh.triangles) {
        const float* p = &values[(key * mesh.vertex_count() + v) * 3];
        copies.insert(copies.end(), p, p + 3);
      }
    }
  };
  copy(mesh.positions, split.positions);
  copy(mesh.normals, split.normals);
  for (size_t i = 0; i < mesh.triangles.size(); ++i) split.triangles[i] = static_cast<uint32_t>(i);
  return split;
}

/// The mesh with three motion keys: it turns, bends and moves away.
inline SkinMesh moving(SkinMesh mesh) {
  const size_t count = mesh.vertex_count();
  for (int key = 1; key < 3; ++key) {
    const auto step = static_cast<float>(key);
    for (size_t v = 0; v < count; ++v) {
      const V3f p = mesh.position(v), n = mesh.normal(v);
      const float angle = 0.12f * step + 0.08f * step * p.y;
      const float c = std::cos(angle), s = std::sin(angle);
      const V3f to = V3f(c * p.x - s * p.z, p.y + 0.05f * step * p.x * p.x, s * p.x + c * p.z) +
                     V3f(0.6f * step, 0.2f * step * step, 0);
      mesh.positions.insert(mesh.positions.end(), {to.x, to.y, to.z});
      mesh.normals.insert(mesh.normals.end(), {n.x, n.y, n.z});
    }
  }
  mesh.motion_keys = 3;
  return mesh;
}

/// Position of a vertex at a time of the shutter.
inline V3f position_at(const SkinMesh& mesh, size_t vertex, float time) {
  if (mesh.motion_keys == 1) return mesh.position(vertex);
  const float scaled = time * static_cast<float>(mesh.motion_keys - 1);
  const int key = std::min(static_cast<int>(scaled), mesh.motion_keys - 2);
  const float t = scaled - static_cast<float>(key);
  return (1 - t) * mesh.position(vertex, key) + t * mesh.position(vertex, key + 1);
}

}  // namespace pelage
