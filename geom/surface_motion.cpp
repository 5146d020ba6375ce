// SPDX-License-Identifier: Apache-2.0
#include "geom/surface_motion.h"

#include <cmath>

#include "geom/surface_topology_impl.h"

namespace pelage {
namespace {

/// The normal of a surface, as long as the sides of its unit square are on average.
V3d scaled_normal(const SurfacePoint& at) {
  const V3d across = V3d(at.du).cross(V3d(at.dv));
  const double area = across.length();
  return area > 0 ? across * (1 / std::sqrt(area)) : V3d(0);
}

}  // namespace

SurfacePoint cage_point(const SurfaceTopology& topology, uint32_t face, float u, float v,
                        const std::function<V3f(uint32_t)>& position) {
  const CageConnectivity& cage = topology.impl().cage;
  const uint32_t whole = topology.impl().cage_face[face], size = cage.face_size(whole);
  const auto corner = [&](uint32_t i) {
    return position(cage.corner_vertex[cage.first_corner[whole] + i % size]);
  };
  if (topology.is_triangular()) {
    const V3f a = corner(0), du = corner(1) - a, dv = corner(2) - a;
    return {a + u * du + v * dv, du, dv};
  }
  V3f c[4] = {corner(0), corner(1), corner(2), corner(3)};
  if (topology.impl().part[face] != 0) {
    // One of the squares into which a polygon is divided: from its corner to the middle of the polygon.
    const uint32_t own = face - cage.first_ptex[whole];
    c[0] = corner(own);
    c[1] = 0.5f * (c[0] + corner(own + 1));
    c[3] = 0.5f * (c[0] + corner(own + size - 1));
    c[2] = V3f(0);
    for (uint32_t i = 0; i < size; ++i) c[2] += corner(i) * (1 / static_cast<float>(size));
  }
  const V3f low = c[0] * (1 - u) + c[1] * u, high = c[3] * (1 - u) + c[2] * u;
  return {low * (1 - v) + high * v, (c[1] - c[0]) * (1 - v) + (c[2] - c[3]) * v, high - low};
}

V3f SurfaceStep::moved(const V3f& point) const {
  const V3d offset = V3d(point) - V3d(now.position), du(now.du), dv(now.dv), n = scaled_normal(now);
  const V3d across = du.cross(dv);
  const double volume = across.dot(n);
  if (!(volume > 0)) return point + (next.position - now.position);
  const double s = offset.dot(dv.cross(n)) / volume, t = offset.dot(n.cross(du)) / volume;
  const double up = offset.dot(across) / volume;
  return V3f(V3d(next.position) + V3d(next.du) * s + V3d(next.dv) * t + scaled_normal(next) * up);
}

V3f SurfaceStep::moved(const V3f& point, const V3f& root) const {
  const Frame from = LimitSurface::frame_of(now), to = LimitSurface::frame_of(next);
  return moved(root) + to.to_world(from.to_local(point - root));
}

}  // namespace pelage
