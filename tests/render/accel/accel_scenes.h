// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "base/hash.h"
#include "geom/strands.h"
#include "geom/tessellation.h"
#include "render/accel/accel.h"

namespace pelage {

/// From a sphere around the scenes of random_strands() through a point near their middle.
inline Ray random_ray(uint64_t seed, uint64_t index) {
  const auto number = [&](uint64_t i) {
    return signed_float(hash64(seed, index, i, random_use("test ray")));
  };
  Ray ray;
  ray.origin = 4.0f * V3f(number(0), number(1), number(2)).normalized();
  ray.direction = (V3f(number(3), number(4), number(5)) - ray.origin).normalized();
  ray.time = 0.5f * (number(6) + 1);
  ray.random = static_cast<uint32_t>(index);
  return ray;
}

/// Straight strands along x at depths 0, 1, 2 ..., with a control point at every whole x.
inline Strands ladder(size_t count, uint64_t first_id = 0, uint32_t points = 8) {
  StrandArrays a;
  a.first_point.push_back(0);
  for (size_t s = 0; s < count; ++s) {
    for (uint32_t i = 0; i < points; ++i) {
      a.points.insert(a.points.end(), {static_cast<float>(i), 0, static_cast<float>(s), 0.05f});
    }
    a.first_point.push_back(a.first_point.back() + points);
    a.ids.push_back(first_id + s);
  }
  return Strands(std::move(a));
}

/// A ray from z = -1 towards +z.
inline Ray along_z(float x, float y = 0) {
  Ray ray;
  ray.origin = {x, y, -1};
  return ray;
}

/// Two triangles facing -z.
inline SkinMesh quad(float z) {
  SkinMesh mesh;
  mesh.positions = {-1, -1, z, 9, -1, z, 9, 1, z, -1, 1, z};
  mesh.normals = {0, 0, -1, 0, 0, -1, 0, 0, -1, 0, 0, -1};
  mesh.triangles = {0, 1, 2, 0, 2, 3};
  mesh.faces = {0, 0};
  mesh.vertex_uv.assign(6, V2f(0));
  return mesh;
}

}  // namespace pelage
