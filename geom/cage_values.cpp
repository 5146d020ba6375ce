// SPDX-License-Identifier: Apache-2.0
#include "geom/cage_values.h"

#include "geom/surface_topology_impl.h"

namespace pelage {

CageValues::CageValues(std::shared_ptr<const SurfaceTopology> topology, std::vector<Rgb> values)
    : topology_(std::move(topology)), values_(std::move(values)) {}

Rgb CageValues::at(uint32_t face, float u, float v) const {
  const SurfaceTopology::Impl& impl = topology_->impl();
  const CageConnectivity& cage = impl.cage;
  const uint32_t cage_face = impl.flat ? face : impl.cage_face[face];
  const uint32_t n = cage.face_size(cage_face);
  const auto corner = [&](uint32_t i) {
    return values_[cage.corner_vertex[cage.first_corner[cage_face] + i % n]];
  };
  if (impl.triangular) return corner(0) * (1 - u - v) + corner(1) * u + corner(2) * v;
  const auto bilinear = [&](const Rgb& a, const Rgb& b, const Rgb& c, const Rgb& d) {
    return (a * (1 - u) + b * u) * (1 - v) + (d * (1 - u) + c * u) * v;
  };
  if (!impl.part[face]) return bilinear(corner(0), corner(1), corner(2), corner(3));
  Rgb middle(0);
  for (uint32_t i = 0; i < n; ++i) middle += corner(i) * (1.0f / static_cast<float>(n));
  const uint32_t i = face - cage.first_ptex[cage_face];
  return bilinear(corner(i), 0.5f * (corner(i) + corner(i + 1)), middle,
                  0.5f * (corner(i) + corner(i + n - 1)));
}

namespace {

/// The point of a surface at corner `i` of a face of the cage.
SurfacePoint at_corner(const LimitSurface& surface, uint32_t cage_face, uint32_t i, V3f& normal) {
  constexpr float kU[] = {0, 1, 1, 0}, kV[] = {0, 0, 1, 1}, kTriangleU[] = {0, 1, 0},
                  kTriangleV[] = {0, 0, 1};
  const SurfaceTopology::Impl& impl = surface.topology().impl();
  const uint32_t first = impl.flat ? cage_face : impl.cage.first_ptex[cage_face];
  const bool part = !impl.triangular && impl.part[first];
  const uint32_t face = part ? first + i : first;
  const float u = impl.triangular ? kTriangleU[i] : part ? 0 : kU[i];
  const float v = impl.triangular ? kTriangleV[i] : part ? 0 : kV[i];
  const SurfacePoint point = surface.evaluate(face, u, v);
  normal = surface.frame(point, face, u, v).normal;
  return point;
}

}  // namespace

std::vector<float> vertex_curvatures(const LimitSurface& surface) {
  const CageConnectivity& cage = surface.topology().impl().cage;
  const auto faces = static_cast<uint32_t>(cage.first_corner.size()) - 1;
  std::vector<V3f> position(surface.topology().control_count()), normal(position.size());
  for (uint32_t face = 0; face < faces; ++face) {
    for (uint32_t i = 0; i < cage.face_size(face); ++i) {
      const uint32_t vertex = cage.corner_vertex[cage.first_corner[face] + i];
      position[vertex] = at_corner(surface, face, i, normal[vertex]).position;
    }
  }
  // On a ball of radius r, 2 n (p - q) / |p - q|^2 is 1 / r for any two points p and q, where n is the normal
  // at p.
  std::vector<float> sum(position.size()), edges(position.size());
  for (uint32_t face = 0; face < faces; ++face) {
    const uint32_t first = cage.first_corner[face], n = cage.face_size(face);
    for (uint32_t i = 0; i < n; ++i) {
      const uint32_t ends[] = {cage.corner_vertex[first + i], cage.corner_vertex[first + (i + 1) % n]};
      const V3f step = position[ends[0]] - position[ends[1]];
      const float length2 = step.dot(step);
      if (!(length2 > 0)) continue;
      sum[ends[0]] += 2 * normal[ends[0]].dot(step) / length2;
      sum[ends[1]] -= 2 * normal[ends[1]].dot(step) / length2;
      ++edges[ends[0]];
      ++edges[ends[1]];
    }
  }
  for (size_t v = 0; v < sum.size(); ++v) sum[v] = edges[v] > 0 ? sum[v] / edges[v] : 0.0f;
  return sum;
}

}  // namespace pelage
