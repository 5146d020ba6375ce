// SPDX-License-Identifier: Apache-2.0
#include "world/terrain.h"

#include <algorithm>
#include <cmath>

#include "base/memory_budget.h"

namespace pelage {
namespace {

constexpr const char* kWhat = "the ground of a crowd";

constexpr double kMaxTriangles = 1 << 20;  // of a coarse cage; dense ones have those of their faces

int steps_of(const SurfaceTopology& topology) {
  if (topology.is_flat()) return 1;
  return std::clamp(static_cast<int>(std::sqrt(kMaxTriangles / 2 / topology.face_count())), 1, 16);
}

/// Weights of the corners at (x, z) of a triangle seen from above; false outside of it.
bool weights_at(const V3f (&corner)[3], float x, float z, double (&weights)[3]) {
  const auto cross = [&](const V3f& a, const V3f& b) {
    return (double(a.x) - x) * (double(b.z) - z) - (double(b.x) - x) * (double(a.z) - z);
  };
  double sum = 0;
  for (int i = 0; i < 3; ++i) sum += weights[i] = cross(corner[(i + 1) % 3], corner[(i + 2) % 3]);
  if (sum == 0) return false;
  for (double& weight : weights) weight /= sum;
  constexpr double kOutside = -1e-6;  // no gaps between triangles
  return weights[0] >= kOutside && weights[1] >= kOutside && weights[2] >= kOutside;
}

}  // namespace

Terrain::Terrain(std::vector<Surface> surfaces, const Job& job) : surfaces_(std::move(surfaces)) {
  size_t count = 0;
  for (const Surface& surface : surfaces_) {
    const SurfaceTopology& topology = surface.rest->topology();
    const auto steps = static_cast<size_t>(steps_of(topology));
    count += 2 * steps * steps * topology.face_count();
  }
  charge_ = reserve(job.ledger, MemoryTag::kSkins, static_cast<int64_t>(count * sizeof(Triangle)), kWhat);
  triangles_.reserve(count);
  for (uint32_t i = 0; i < surfaces_.size(); ++i) add_triangles(i, job);
  sort_into_cells(job);
}

void Terrain::add_triangles(uint32_t surface, const Job& job) {
  const auto& [rest, to_world] = surfaces_[surface];
  const SurfaceTopology& topology = rest->topology();
  const int steps = steps_of(topology);
  const auto add = [&](uint32_t face, const V2f& a, const V2f& b, const V2f& c) {
    Triangle triangle{surface, face, {}, {a, b, c}};
    for (int i = 0; i < 3; ++i)
      triangle.corner[i] = rest->evaluate(face, triangle.uv[i].x, triangle.uv[i].y).position * to_world;
    triangles_.push_back(triangle);
  };
  for (uint32_t face = 0; face < topology.face_count(); ++face) {
    if (face % 4096 == 0) job.check_stop();
    if (topology.is_hole(face)) continue;
    const auto at = [&](int i, int j) { return V2f(float(i) / float(steps), float(j) / float(steps)); };
    for (int i = 0; i < steps; ++i) {
      for (int j = 0; j < (topology.is_triangular() ? steps - i : steps); ++j) {
        add(face, at(i, j), at(i + 1, j), at(i, j + 1));
        if (!topology.is_triangular() || i + j + 1 < steps)
          add(face, at(i + 1, j), at(i + 1, j + 1), at(i, j + 1));
      }
    }
  }
}

size_t Terrain::cell_of(float value, int axis) const {
  const float cell = (value - low_[axis]) / cell_[axis];
  const size_t count = axis == 0 ? columns_ : rows_;
  return cell > 0 ? std::min(static_cast<size_t>(std::min(cell, 1e9f)), count - 1) : 0;
}

/// Makes a grid of about square cells, half as many as triangles.
void Terrain::sort_into_cells(const Job& job) {
  Box3f box;
  for (const Triangle& triangle : triangles_) {
    for (const V3f& corner : triangle.corner) box.extendBy(corner);
  }
  if (box.isEmpty()) return;
  low_ = V2f(box.min.x, box.min.z);
  const V2f size(std::max(box.size().x, 1e-30f), std::max(box.size().z, 1e-30f));
  const double cells = std::max(1.0, double(triangles_.size()) / 2);
  columns_ = static_cast<size_t>(std::clamp(std::sqrt(cells * double(size.x) / double(size.y)), 1.0, cells));
  rows_ = std::max<size_t>(1, static_cast<size_t>(cells) / columns_);
  cell_ = V2f(size.x / static_cast<float>(columns_), size.y / static_cast<float>(rows_));
  const auto for_each_cell = [&](const Triangle& triangle, const auto& visit) {
    Box3f own;
    for (const V3f& corner : triangle.corner) own.extendBy(corner);
    for (size_t row = cell_of(own.min.z, 1); row <= cell_of(own.max.z, 1); ++row) {
      for (size_t column = cell_of(own.min.x, 0); column <= cell_of(own.max.x, 0); ++column)
        visit(row * columns_ + column);
    }
  };
  const auto grid_bytes = static_cast<int64_t>((2 * columns_ * rows_ + 1) * sizeof(uint32_t));
  cells_charge_ = reserve(job.ledger, MemoryTag::kSkins, grid_bytes, kWhat);
  first_.assign(columns_ * rows_ + 1, 0);
  size_t entries = 0;
  for (const Triangle& triangle : triangles_) {
    for_each_cell(triangle, [&](size_t cell) {
      ++first_[cell + 1];
      ++entries;
    });
  }
  const auto entry_bytes = static_cast<int64_t>(entries * sizeof(uint32_t));
  require_memory(job.ledger, entry_bytes, kWhat);
  cells_charge_ = {};
  cells_charge_ = MemoryCharge(job.ledger, MemoryTag::kSkins, grid_bytes + entry_bytes);
  for (size_t cell = 0; cell + 1 < first_.size(); ++cell) first_[cell + 1] += first_[cell];
  in_cells_.resize(first_.back());
  std::vector<uint32_t> next(first_.begin(), first_.end() - 1);
  for (uint32_t i = 0; i < triangles_.size(); ++i)
    for_each_cell(triangles_[i], [&](size_t cell) { in_cells_[next[cell]++] = i; });
}

// Newton's method in the parameters of the face, which converges in a few steps from a small triangle. A face
// that is nearly vertical keeps the point of the triangle.
Terrain::Point Terrain::refined(const Triangle& triangle, V2f uv, float x, float z) const {
  const auto& [rest, to_world] = surfaces_[triangle.surface];
  Point result;
  for (int step = 0; step < 4; ++step) {
    const SurfacePoint point = rest->evaluate(triangle.face, uv.x, uv.y);
    const V3f position = point.position * to_world;
    V3f du, dv;
    to_world.multDirMatrix(point.du, du);
    to_world.multDirMatrix(point.dv, dv);
    V3f normal;
    to_world.multDirMatrix(LimitSurface::frame_of(point).normal, normal);
    result = {position.y, normal.y < 0 ? -normal.normalized() : normal.normalized()};
    const float determinant = du.x * dv.z - du.z * dv.x;
    if (std::abs(determinant) < 1e-6f * du.length() * dv.length()) break;
    const float dx = x - position.x, dz = z - position.z;
    const V2f change((dx * dv.z - dz * dv.x) / determinant, (du.x * dz - du.z * dx) / determinant);
    result.height += change.x * du.y + change.y * dv.y;
    uv = V2f(std::clamp(uv.x + change.x, 0.0f, 1.0f), std::clamp(uv.y + change.y, 0.0f, 1.0f));
  }
  return result;
}

std::optional<Terrain::Point> Terrain::at(float x, float z) const {
  if (first_.empty()) return {};
  const size_t cell = cell_of(z, 1) * columns_ + cell_of(x, 0);
  std::optional<Point> highest;
  for (uint32_t i = first_[cell]; i < first_[cell + 1]; ++i) {
    const Triangle& triangle = triangles_[in_cells_[i]];
    double weights[3];
    if (!weights_at(triangle.corner, x, z, weights)) continue;
    V2f uv(0);
    for (int k = 0; k < 3; ++k) uv += static_cast<float>(weights[k]) * triangle.uv[k];
    const Point point = refined(triangle, uv, x, z);
    if (!highest || point.height > highest->height) highest = point;
  }
  return highest;
}

}  // namespace pelage
