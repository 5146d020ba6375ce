// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <memory>

#include "geom/limit_surface.h"
#include "geom/mesh.h"
#include "geom/strands.h"
#include "geom/tessellation.h"
#include "render/sampling/sample_stream.h"
#include "render/sampling/warp.h"

namespace pelage {

/// A skin of flat plates, each a face of the rest surface, and straight hair that grows on them.
class Plates {
 public:
  /// Adds the parallelogram with the corner `at` and the edges `u` and `v`. It faces u x v.
  uint32_t add(const V3f& at, const V3f& u, const V3f& v) {
    const auto first = static_cast<uint32_t>(cage_.positions.size());
    const V3f normal = u.cross(v).normalized();
    const V2f places[] = {{0, 0}, {1, 0}, {1, 1}, {0, 1}};
    for (const V2f& place : places) {
      const V3f p = at + place.x * u + place.y * v;
      cage_.face_vertices.push_back(static_cast<uint32_t>(cage_.positions.size()));
      cage_.positions.push_back(p);
      mesh_.positions.insert(mesh_.positions.end(), {p.x, p.y, p.z});
      mesh_.normals.insert(mesh_.normals.end(), {normal.x, normal.y, normal.z});
    }
    const auto face = static_cast<uint32_t>(cage_.face_sizes.size());
    for (const uint32_t i : {0u, 1u, 2u, 0u, 2u, 3u}) {
      mesh_.triangles.push_back(first + i);
      mesh_.vertex_uv.push_back(places[i]);
    }
    mesh_.faces.insert(mesh_.faces.end(), {face, face});
    cage_.face_sizes.push_back(4);
    cage_.face_groups.push_back(0);
    return face;
  }
  /// Adds the six sides of a box, which face outwards.
  void add_box(const V3f& low, const V3f& high) {
    const V3f size = high - low, x(size.x, 0, 0), y(0, size.y, 0), z(0, 0, size.z);
    add(low, z, y);      // left
    add(low + x, y, z);  // right
    add(low, x, z);      // bottom
    add(low + y, z, x);  // top
    add(low, y, x);      // back
    add(low + z, x, y);  // front
  }
  /// Adds hair to the part [low, high] of a face.
  void grow(StrandArrays& hair, uint32_t face, int count, float length, float radius, V2f low = V2f(0),
            V2f high = V2f(1)) const {
    if (hair.first_point.empty()) hair.first_point = {0};
    const V3f* corner = &cage_.positions[4 * face];
    const V3f u = corner[1] - corner[0], v = corner[3] - corner[0], up = u.cross(v).normalized();
    for (int i = 0; i < count; ++i) {
      const auto id = static_cast<uint32_t>(hair.ids.size());
      SampleStream stream(23, id, face, 0);
      const V2f random = stream.next2d();
      const V2f at(low.x + random.x * (high.x - low.x), low.y + random.y * (high.y - low.y));
      const V3f along = (up + 0.3f * uniform_direction(stream.next2d())).normalized();
      for (int k = 0; k < 4; ++k) {
        const V3f p = corner[0] + at.x * u + at.y * v + (length * static_cast<float>(k) / 3) * along;
        hair.points.insert(hair.points.end(), {p.x, p.y, p.z, radius});
      }
      hair.first_point.push_back(static_cast<uint32_t>(hair.points.size() / 4));
      hair.ids.push_back(id);
      hair.roots.push_back({face, at.x, at.y});
      hair.root_uv.push_back(at);
    }
  }
  const SkinMesh& mesh() const { return mesh_; }
  std::shared_ptr<const LimitSurface> rest() const {
    ControlMesh cage = cage_;
    cage.groups = {""};
    return std::make_shared<const LimitSurface>(
        SurfaceTopology::create(cage, SubdivisionScheme::kBilinear, BoundaryRule::kEdgeAndCorner, "plates"),
        cage.positions);
  }

 private:
  ControlMesh cage_;
  SkinMesh mesh_;
};

}  // namespace pelage
