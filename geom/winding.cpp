// SPDX-License-Identifier: Apache-2.0
#include "geom/winding.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <compare>
#include <numeric>

namespace pelage {
namespace {

/// Returns whether the edge between `low` and `high` (low.y < high.y) is to the right of `point`. Both
/// triangles at an edge get the same answer, because the arguments are the same bits.
bool is_right_of(const V3d& point, const V3d& low, const V3d& high) {
  return (high.x - low.x) * (point.y - low.y) - (high.y - low.y) * (point.x - low.x) > 0;
}

/// Winding number (-1, 0 or 1) of a triangle about a point, both projected along z: signed crossings of its
/// edges with the ray from the point to the right. An edge contains its lower end, but not its upper one.
int projected_winding(const std::array<V3d, 3>& corners, const V3d& point) {
  int winding = 0;
  for (size_t i = 0; i < 3; ++i) {
    const V3d &a = corners[i], &b = corners[(i + 1) % 3];
    if (a.y <= point.y && point.y < b.y) winding += is_right_of(point, a, b) ? 1 : 0;
    if (b.y <= point.y && point.y < a.y) winding -= is_right_of(point, b, a) ? 1 : 0;
  }
  return winding;
}

/// Height of the plane of a triangle above `point`, relative to the point. The triangle covers the point.
double height_over(const std::array<V3d, 3>& corners, const V3d& point) {
  const V3d normal = (corners[1] - corners[0]).cross(corners[2] - corners[0]);
  if (normal.z == 0) return corners[0].z - point.z;
  const V3d to = corners[0] - point;
  return to.dot(normal) / normal.z;
}

/// Returns, for each vertex, one of the vertices that are at the same position at every motion key.
std::vector<uint32_t> welded_vertices(const SkinMesh& mesh) {
  std::vector<uint32_t> order(mesh.vertex_count()), welded(mesh.vertex_count());
  std::iota(order.begin(), order.end(), 0u);
  /// Compares the positions of two vertices by motion key and axis: negative, 0 or positive.
  const auto compare = [&](uint32_t a, uint32_t b) {
    for (int key = 0; key < mesh.motion_keys; ++key) {
      const V3f p = mesh.position(a, key), q = mesh.position(b, key);
      for (int axis = 0; axis < 3; ++axis) {
        const auto relation = std::weak_order(p[axis], q[axis]);  // also of values that are not numbers
        if (relation != 0) return relation < 0 ? -1 : 1;
      }
    }
    return 0;
  };
  std::sort(order.begin(), order.end(), [&](uint32_t a, uint32_t b) { return compare(a, b) < 0; });
  for (size_t i = 0; i < order.size(); ++i) {
    const bool is_first = i == 0 || compare(order[i - 1], order[i]) != 0;
    welded[order[i]] = is_first ? order[i] : welded[order[i - 1]];
  }
  return welded;
}

}  // namespace

bool is_closed(const SkinMesh& mesh) {
  const std::vector<uint32_t> welded = welded_vertices(mesh);
  std::vector<std::array<uint32_t, 3>> edges;  // lower vertex, higher vertex, direction
  edges.reserve(mesh.triangles.size());
  for (size_t t = 0; t < mesh.triangle_count(); ++t) {
    for (size_t i = 0; i < 3; ++i) {
      const uint32_t a = welded[mesh.triangles[3 * t + i]], b = welded[mesh.triangles[3 * t + (i + 1) % 3]];
      if (a != b) edges.push_back({std::min(a, b), std::max(a, b), a < b ? 1u : 0u});
    }
  }
  std::sort(edges.begin(), edges.end());
  for (size_t i = 0, end = 0; i < edges.size(); i = end) {
    int64_t sum = 0;
    for (end = i; end < edges.size() && edges[end][0] == edges[i][0] && edges[end][1] == edges[i][1]; ++end)
      sum += edges[end][2] == 1 ? 1 : -1;
    if (sum != 0) return false;
  }
  return !edges.empty();
}

WindingNumbers::WindingNumbers(const SkinMesh& mesh, int key) : mesh_(mesh), key_(key) {
  Box3f box;
  for (size_t v = 0; v < mesh.vertex_count(); ++v) box.extendBy(mesh.position(v, key));
  const double triangles = static_cast<double>(mesh.triangle_count());
  side_ = std::clamp(static_cast<int>(std::sqrt(triangles)), 1, 1024);
  if (mesh.triangle_count() > 0) {
    origin_ = {box.min.x, box.min.y};
    for (int axis = 0; axis < 2; ++axis) {
      const float size = box.max[axis] - box.min[axis];
      scale_[axis] = size > 0 ? static_cast<float>(side_) / size : 0.0f;
    }
  }
  const auto visit = [&](const auto& add) {
    for (uint32_t t = 0; t < mesh.triangle_count(); ++t) {
      Box3f of;
      for (size_t i = 0; i < 3; ++i) of.extendBy(mesh.position(mesh.triangles[3 * size_t(t) + i], key));
      const Range xs = columns(of.min.x, of.max.x, 0), ys = columns(of.min.y, of.max.y, 1);
      for (int y = ys.begin; y < ys.end; ++y) {
        for (int x = xs.begin; x < xs.end; ++x) add(static_cast<size_t>(y) * side_ + x, t);
      }
    }
  };
  first_.assign(static_cast<size_t>(side_) * side_ + 1, 0);
  visit([&](size_t column, uint32_t) { ++first_[column + 1]; });
  for (size_t i = 1; i < first_.size(); ++i) first_[i] += first_[i - 1];
  triangles_.resize(first_.back());
  std::vector<uint32_t> next(first_.begin(), first_.end() - 1);
  visit([&](size_t column, uint32_t triangle) { triangles_[next[column]++] = triangle; });
}

/// The columns that an interval overlaps. Rounding is monotonic, so a point in the interval is in one of
/// them.
WindingNumbers::Range WindingNumbers::columns(float low, float high, int axis) const {
  const auto column = [&](float x) {
    return static_cast<int>(
        std::clamp((x - origin_[axis]) * scale_[axis], 0.0f, static_cast<float>(side_ - 1)));
  };
  return {column(low), column(high) + 1};
}

int WindingNumbers::at(const V3f& point) const {
  const size_t column = static_cast<size_t>(columns(point.y, point.y, 1).begin) * side_ +
                        static_cast<size_t>(columns(point.x, point.x, 0).begin);
  const V3d from(point);
  int winding = 0;
  for (uint32_t i = first_[column]; i < first_[column + 1]; ++i) {
    const uint32_t* vertices = &mesh_.triangles[3 * size_t(triangles_[i])];
    const std::array<V3d, 3> corners{V3d(mesh_.position(vertices[0], key_)),
                                     V3d(mesh_.position(vertices[1], key_)),
                                     V3d(mesh_.position(vertices[2], key_))};
    const int covers = projected_winding(corners, from);
    if (covers != 0 && height_over(corners, from) > 0) winding += covers;
  }
  return winding;
}

}  // namespace pelage
