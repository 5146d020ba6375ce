// SPDX-License-Identifier: Apache-2.0
#include "groom/strands/skin_binding.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "base/check.h"
#include "base/job.h"
#include "base/memory_budget.h"
#include "geom/closest_point.h"
#include "geom/tessellation.h"

namespace pelage {

struct SkinBinding::Impl {
  SkinMesh mesh;
  ClosestPointTree tree;
  MemoryCharge charge;
  Impl(SkinMesh&& m, const Job& job)
      : mesh(std::move(m)),
        tree(mesh, 0, &job),
        charge(job.ledger, MemoryTag::kGrooms, static_cast<int64_t>(mesh.bytes() + tree.bytes())) {}
};

namespace {

SkinMesh tessellate_evenly(const LimitSurface& rest, const std::filesystem::path& strands, const Job& job) {
  View everywhere;
  everywhere.focal_pixels = 1e12f;  // so that every edge exceeds the max rate
  TessellationOptions options;
  // About a hundred thousand quads for any cage.
  const double faces = std::max(1.0, static_cast<double>(rest.topology().face_count()));
  options.max_rate =
      rest.topology().is_flat() ? 1 : std::clamp(static_cast<int>(std::sqrt(1e5 / faces)), 2, 16);
  constexpr double kBytesPerQuad = 300;  // a vertex, two triangles and the tree over them
  require_memory(job.ledger,
                 static_cast<int64_t>(faces * options.max_rate * options.max_rate * kBytesPerQuad),
                 "finding the roots of " + strands.string() + " on its skin");
  job.check_stop();
  return tessellate(std::span(&rest, 1), everywhere, options, job);
}

/// Parameters of a point of a triangle, by its barycentric coordinates.
RootAddress address_of(const SkinMesh& mesh, uint32_t triangle, const V3f& point) {
  const uint32_t* corner = &mesh.triangles[3 * static_cast<size_t>(triangle)];
  const V2f* uv = &mesh.vertex_uv[3 * static_cast<size_t>(triangle)];
  const V3f a = mesh.position(corner[0]);
  const V3f ab = mesh.position(corner[1]) - a, ac = mesh.position(corner[2]) - a, ap = point - a;
  const V3f normal = ab.cross(ac);
  const float area = normal.dot(normal);
  float wb = 0, wc = 0;
  if (area > 0) {
    wb = std::clamp(ap.cross(ac).dot(normal) / area, 0.0f, 1.0f);
    wc = std::clamp(ab.cross(ap).dot(normal) / area, 0.0f, 1.0f - wb);
  }
  const V2f at = uv[0] * (1 - wb - wc) + uv[1] * wb + uv[2] * wc;
  return {mesh.faces[triangle], std::clamp(at.x, 0.0f, 1.0f), std::clamp(at.y, 0.0f, 1.0f)};
}

}  // namespace

SkinBinding::SkinBinding(const LimitSurface& rest, const std::filesystem::path& strands, const Job& job)
    : impl_(std::make_unique<Impl>(tessellate_evenly(rest, strands, job), job)) {}
SkinBinding::~SkinBinding() = default;

bool SkinBinding::empty() const { return impl_->mesh.triangle_count() == 0; }

RootAddress SkinBinding::nearest(const V3f& point) const {
  ClosestPoint closest;
  const bool found = impl_->tree.closest(point, std::numeric_limits<float>::infinity(), closest);
  PELAGE_CHECK(found);
  return address_of(impl_->mesh, closest.triangle, closest.position);
}

}  // namespace pelage
