// SPDX-License-Identifier: Apache-2.0
#include "geom/limit_surface.h"

#include <algorithm>
#include <cmath>

#include "base/check.h"
#include "geom/surface_topology_impl.h"

namespace pelage {

namespace {

// Below this sine of the angle between du and dv there is no plane to speak of.
constexpr double kFlatSine = 1e-4;

float into_unit(float x) { return x > 0 ? std::min(x, 1.0f) : 0.0f; }  // NaN becomes 0

/// Normal of a parallelogram in double, so that no size of cage under- or overflows; false when it has none.
bool normal_of(const V3f& du, const V3f& dv, V3f& normal) {
  const V3d a(du), b(dv);
  const V3d n = a.cross(b);
  const double area = n.length(), longest = std::max(a.length2(), b.length2());
  if (!(area > kFlatSine * longest) || !std::isfinite(area)) return false;
  normal = V3f(n / area);
  return true;
}

Frame frame_around(const V3f& normal, const V3f& along) {
  const V3d n(normal);
  V3d tangent = V3d(along) - n * n.dot(V3d(along));
  const double length = tangent.length();
  if (length > 0 && std::isfinite(length)) {
    tangent /= length;
  } else {
    // Any direction across the normal: the axis that is farthest from it, made perpendicular.
    V3d axis(0);
    axis[std::abs(n.x) < 0.6 ? 0 : 1] = 1;
    tangent = (axis - n * n.dot(axis)).normalized();
  }
  return {V3f(tangent), V3f(n.cross(tangent)), normal};
}

}  // namespace

LimitSurface::LimitSurface(std::shared_ptr<const SurfaceTopology> topology, std::span<const V3f> positions)
    : topology_(std::move(topology)) {
  const SurfaceTopology::Impl& impl = topology_->impl();
  PELAGE_CHECK(positions.size() == impl.control_count);
  points_.resize(impl.rules.point_count() * 3);
  for (size_t i = 0; i < positions.size(); ++i) {
    std::copy_n(&positions[i].x, 3, &points_[i * 3]);
    bounds_.extendBy(positions[i]);
  }
  impl.rules.apply(points_.data());
}

SurfacePoint LimitSurface::evaluate(uint32_t face, float u, float v) const {
  const SurfaceTopology::Impl& impl = topology_->impl();
  u = into_unit(u);
  v = into_unit(v);
  if (impl.triangular && u + v > 1) {
    u /= u + v;
    v = 1 - u;
  }
  const Far::PatchTable::PatchHandle* handle = impl.patch_map->FindPatch(static_cast<int>(face), u, v);
  PELAGE_CHECK(handle);
  float weights[20], du_weights[20], dv_weights[20];
  impl.patches->EvaluateBasis(*handle, u, v, weights, du_weights, dv_weights);
  const Far::ConstIndexArray vertices = impl.patches->GetPatchVertices(*handle);
  // Relative to one of the points, so that a surface far from the origin keeps its derivatives.
  const float* origin = &points_[static_cast<size_t>(vertices[0]) * 3];
  SurfacePoint result;
  for (int i = 0; i < vertices.size(); ++i) {
    const float* p = &points_[static_cast<size_t>(vertices[i]) * 3];
    const V3f offset(p[0] - origin[0], p[1] - origin[1], p[2] - origin[2]);
    result.position += weights[i] * offset;
    result.du += du_weights[i] * offset;
    result.dv += dv_weights[i] * offset;
  }
  result.position += V3f(origin[0], origin[1], origin[2]);
  return result;
}

Frame LimitSurface::frame_of(const SurfacePoint& point) {
  V3f normal;
  if (normal_of(point.du, point.dv, normal)) return frame_around(normal, point.du);
  // No plane: across du, or across dv, or the axes.
  const bool has_du = point.du.length() > 0;
  const V3f along = has_du ? point.du : point.dv;
  if (!(along.length() > 0) || !std::isfinite(along.length())) return {};
  const Frame across = frame_around(along.normalized(), V3f(0));
  return {along.normalized(), across.bitangent, across.normal};
}

Frame LimitSurface::frame(const SurfacePoint& here, uint32_t face, float u, float v) const {
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

size_t LimitSurface::bytes() const { return sizeof(*this) + points_.capacity() * sizeof(float); }

}  // namespace pelage
