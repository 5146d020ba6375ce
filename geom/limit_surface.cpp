// SPDX-License-Identifier: Apache-2.0
#include "geom/limit_surface.h"

#include <algorithm>
#include <cmath>
#include <cstring>

#include "base/check.h"
#include "geom/flat_topology.h"
#include "geom/four_lanes.h"
#include "geom/surface_topology_impl.h"

namespace pelage {

namespace {

// Below this sine of the angle between du and dv, the tangent plane is undefined.
constexpr double kFlatSine = 1e-4;

/// A point, followed by one more float.
Four load(const std::vector<float>& points, size_t index) {
  Four p;
  std::memcpy(&p, &points[index * 3], sizeof p);
  return p;
}

V3f xyz_of(Four p) { return {p[0], p[1], p[2]}; }

float into_unit(float x) { return x > 0 ? std::min(x, 1.0f) : 0.0f; }  // NaN becomes 0

/// Normal of a parallelogram, computed in double, so that no size of cage under- or overflows; false when it
/// has none.
bool normal_of(const V3f& du, const V3f& dv, V3f& normal) {
  const V3d a(du), b(dv);
  const V3d n = a.cross(b);
  const double area = n.length(), longest = std::max(a.length2(), b.length2());
  if (!(area > kFlatSine * longest) || !std::isfinite(area)) return false;
  normal = V3f(n / area);
  return true;
}

/// Any unit vector perpendicular to `n`: the axis that is farthest from it, orthogonalised.
V3d across(const V3d& n) {
  V3d axis(0);
  axis[std::abs(n.x) < 0.6 ? 0 : 1] = 1;
  return (axis - n * n.dot(axis)).normalized();
}

/// `along` must be perpendicular to `normal`, except for rounding.
Frame frame_around(const V3f& normal, const V3f& along) {
  const V3d n(normal), a(along);
  const V3d tangent = (a - n * n.dot(a)).normalized();
  return {V3f(tangent), V3f(n.cross(tangent)), normal};
}

/// `along` may point anywhere.
Frame smooth_frame(const V3f& normal, const V3f& along) {
  const V3d n(normal), a(along);
  const V3d flat = a - n * n.dot(a);
  const bool clear = flat.length() > kFlatSine * a.length() && std::isfinite(flat.length());
  const V3d tangent = clear ? flat.normalized() : across(n);
  return {V3f(tangent), V3f(n.cross(tangent)), normal};
}

}  // namespace

SurfaceTopology::PoseBytes SurfaceTopology::pose_bytes() const {
  const size_t points = impl_->rules.point_count();
  if (impl_->flat) return {sizeof(LimitSurface) + (points * 6 + 1) * sizeof(float), 0};
  return {sizeof(LimitSurface) + (points * 3 + 1) * sizeof(float), PointRules::temporary_bytes(points)};
}

SurfaceTopology::PoseBytes SurfaceTopology::pose_bytes(std::span<const uint32_t> faces) const {
  const PointBlocks blocks = impl_->points_of(faces);
  const size_t points = blocks.point_count();
  return {sizeof(LimitSurface) + (points * (impl_->flat ? 6 : 3) + 1) * sizeof(float) +
              blocks.place.size() * sizeof(uint32_t),
          // Points, which of them are needed, and those that are still to be processed.
          PointRules::temporary_bytes(points) + blocks.wanted.size() * sizeof(uint16_t) +
              2 * points * sizeof(uint32_t)};
}

LimitSurface::LimitSurface(std::shared_ptr<const SurfaceTopology> topology, std::span<const V3f> positions)
    : topology_(std::move(topology)) {
  const SurfaceTopology::Impl& impl = topology_->impl();
  measure(positions);
  points_.resize(impl.rules.point_count() * 3 + 1);  // every point may be loaded as a vector of four
  for (size_t i = 0; i < positions.size(); ++i) {
    const V3f p = positions[i] - origin_;
    std::copy_n(&p.x, 3, &points_[i * 3]);
  }
  if (impl.flat) {
    normals_.resize(positions.size() * 3);
    for (uint32_t i = 0; i < positions.size(); ++i) set_normal(i, positions);
    return;
  }
  impl.rules.apply(points_.data());
}

LimitSurface::LimitSurface(std::shared_ptr<const SurfaceTopology> topology, std::span<const V3f> positions,
                           std::span<const uint32_t> faces)
    : topology_(std::move(topology)) {
  const SurfaceTopology::Impl& impl = topology_->impl();
  measure(positions);
  PointBlocks blocks = impl.points_of(faces);
  points_.resize(blocks.point_count() * 3 + 1);
  for (uint32_t i = 0; i < positions.size(); ++i) {
    if (blocks.place[i / PointBlocks::kSize] == PointBlocks::kAbsent) continue;
    const V3f p = positions[i] - origin_;
    std::copy_n(&p.x, 3, &points_[blocks[i] * 3]);
  }
  if (!impl.flat) impl.rules.apply(points_.data(), blocks);
  blocks_ = std::move(blocks.place);
  if (!impl.flat) return;
  normals_.resize(points_.size() - 1);
  for (uint32_t i = 0; i < positions.size(); ++i) {
    if (blocks.wanted[i / PointBlocks::kSize] >> i % PointBlocks::kSize & 1) set_normal(i, positions);
  }
}

void LimitSurface::set_normal(uint32_t vertex, std::span<const V3f> positions) {
  const V3f normal = flat_vertex_normal(topology_->impl(), positions, vertex);
  std::copy_n(&normal.x, 3, &normals_[place_of(static_cast<int>(vertex)) * 3]);
}

void LimitSurface::measure(std::span<const V3f> positions) {
  PELAGE_CHECK(positions.size() == topology_->impl().control_count);
  for (const V3f& p : positions) bounds_.extendBy(p);
  origin_ = bounds_.center();
}

size_t LimitSurface::place_of(int point) const {
  const auto p = static_cast<uint32_t>(point);
  if (blocks_.empty()) return p;
  const uint32_t block = blocks_[p / PointBlocks::kSize];
  PELAGE_CHECK(block != PointBlocks::kAbsent);
  return size_t(block) * PointBlocks::kSize + p % PointBlocks::kSize;
}

SurfacePoint LimitSurface::evaluate(uint32_t face, float u, float v) const {
  const SurfaceTopology::Impl& impl = topology_->impl();
  u = into_unit(u);
  v = into_unit(v);
  if (impl.triangular && u + v > 1) {
    u /= u + v;
    v = 1 - u;
  }
  if (impl.flat) return evaluate_flat(face, u, v);
  const Far::PatchTable::PatchHandle* handle = impl.patch_map->FindPatch(static_cast<int>(face), u, v);
  PELAGE_CHECK(handle);
  float weights[20], du_weights[20], dv_weights[20];
  impl.patches->EvaluateBasis(*handle, u, v, weights, du_weights, dv_weights);
  const Far::ConstIndexArray vertices = impl.patches->GetPatchVertices(*handle);
  // Relative to the first of them, so that small patches of a large surface keep precise derivatives.
  const Four first = load(points_, place_of(vertices[0]));
  Four position = four(0), du = four(0), dv = four(0);
  for (int i = 1; i < vertices.size(); ++i) {
    const Four p = load(points_, place_of(vertices[i])) - first;
    position += four(weights[i]) * p;
    du += four(du_weights[i]) * p;
    dv += four(dv_weights[i]) * p;
  }
  position += first;
  SurfacePoint result{xyz_of(position) + origin_, xyz_of(du), xyz_of(dv)};
  if (impl.part[face]) {
    // OpenSubdiv's derivatives use the parameters of a quad of which this ptex face would be a quarter.
    result.du *= 0.5f;
    result.dv *= 0.5f;
  }
  return result;
}

SurfacePoint LimitSurface::evaluate_flat(uint32_t face, float u, float v) const {
  const std::vector<uint32_t>& corner_vertex = topology_->impl().cage.corner_vertex;
  PELAGE_CHECK(face < topology_->face_count());
  V3f p[3], n[3];
  for (size_t i = 0; i < 3; ++i) {
    const size_t at = 3 * place_of(static_cast<int>(corner_vertex[3 * size_t(face) + i]));
    p[i] = V3f(points_[at], points_[at + 1], points_[at + 2]);
    n[i] = V3f(normals_[at], normals_[at + 1], normals_[at + 2]);
  }
  SurfacePoint result;
  result.du = p[1] - p[0];
  result.dv = p[2] - p[0];
  result.position = p[0] + u * result.du + v * result.dv + origin_;
  const V3f normal = (1 - u - v) * n[0] + u * n[1] + v * n[2];
  // Vertex normals may cancel in between.
  if (normal.length2() > 1e-6f) result.smooth_normal = normal.normalized();
  return result;
}

Frame LimitSurface::frame_of(const SurfacePoint& point) {
  if (point.smooth_normal != V3f(0)) return smooth_frame(point.smooth_normal, point.du);
  V3f normal;
  if (normal_of(point.du, point.dv, normal)) return frame_around(normal, point.du);
  // The plane is undefined, but perhaps not the line.
  const V3d du(point.du), dv(point.dv);
  const V3d longer = du.length2() >= dv.length2() ? du : dv;
  if (!(longer.length() > 0) || !std::isfinite(longer.length())) return {};
  const V3d tangent = longer.normalized(), n = across(tangent);
  return {V3f(tangent), V3f(n.cross(tangent)), V3f(n)};
}

Frame LimitSurface::frame(const SurfacePoint& here, uint32_t face, float u, float v) const {
  if (here.smooth_normal != V3f(0)) return frame_of(here);
  V3f normal;
  if (normal_of(here.du, here.dv, normal)) return frame_around(normal, here.du);
  const float middle = topology_->impl().triangular ? 1.0f / 3 : 0.5f;
  u = into_unit(u);
  v = into_unit(v);
  for (float step : {1.0f / 1024, 1.0f / 128, 1.0f / 16, 0.5f, 1.0f}) {
    const SurfacePoint near = evaluate(face, u + step * (middle - u), v + step * (middle - v));
    if (normal_of(near.du, near.dv, normal)) return frame_around(normal, near.du);
  }
  return frame_of(here);
}

ContentHash LimitSurface::hash() const {
  PELAGE_CHECK(blocks_.empty());
  // All points depend only on the control points and the topology.
  const auto control = std::span(points_).first(size_t(3) * topology_->control_count());
  return ContentHasher()
      .add(topology_->hash())
      .add(std::span<const float>(control))
      .add(origin_.x)
      .add(origin_.y)
      .add(origin_.z)
      .digest();
}

size_t LimitSurface::bytes() const {
  return sizeof(*this) + (points_.capacity() + normals_.capacity()) * sizeof(float) +
         blocks_.capacity() * sizeof(uint32_t);
}

}  // namespace pelage
