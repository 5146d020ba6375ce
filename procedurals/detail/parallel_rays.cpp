// SPDX-License-Identifier: Apache-2.0
#include "procedurals/detail/parallel_rays.h"

#include <algorithm>
#include <cmath>

namespace pelage {
namespace {

uint32_t clamped(float cell, uint32_t count) {
  return cell > 0 ? std::min(static_cast<uint32_t>(std::min(cell, 1e6f)), count - 1) : 0;
}

}  // namespace

ParallelRays::ParallelRays(const V3f& direction, std::span<const V3f> origins) : direction_(direction) {
  const V3f helper = std::abs(direction.x) < 0.6f ? V3f(1, 0, 0) : V3f(0, 1, 0);
  x_ = direction.cross(helper).normalized();
  y_ = direction.cross(x_);
  std::vector<Ray> rays;
  float right = 0, top = 0;
  for (uint32_t i = 0; i < origins.size(); ++i) {
    const Flat at = flat(origins[i]);
    rays.push_back({at, i});
    left_ = i == 0 ? at.x : std::min(left_, at.x);
    right = i == 0 ? at.x : std::max(right, at.x);
    bottom_ = i == 0 ? at.y : std::min(bottom_, at.y);
    top = i == 0 ? at.y : std::max(top, at.y);
  }
  // About one ray in a cell.
  const float width = right - left_, height = top - bottom_;
  const float longest = std::max({width, height, 1e-30f});
  per_unit_ = std::sqrt(static_cast<float>(std::max<size_t>(1, origins.size()))) / longest;
  columns_ = 1 + static_cast<uint32_t>(width * per_unit_);
  rows_ = 1 + static_cast<uint32_t>(height * per_unit_);
  const auto cell = [&](const Ray& ray) { return row(ray.origin.y) * columns_ + column(ray.origin.x); };
  first_.assign(size_t(columns_) * rows_ + 1, 0);
  for (const Ray& ray : rays) ++first_[cell(ray) + 1];
  for (size_t c = 1; c < first_.size(); ++c) first_[c] += first_[c - 1];
  rays_.resize(rays.size());
  std::vector<uint32_t> next(first_.begin(), first_.end() - 1);
  for (const Ray& ray : rays) rays_[next[cell(ray)]++] = ray;
}

uint32_t ParallelRays::column(float x) const { return clamped((x - left_) * per_unit_, columns_); }
uint32_t ParallelRays::row(float y) const { return clamped((y - bottom_) * per_unit_, rows_); }

void ParallelRays::meet(const StrandPiece& piece, float widen, std::vector<Pass>& passes) const {
  const Flat a = flat(piece.begin), b = flat(piece.end);
  const float reach = widen * std::max(piece.begin_radius, piece.end_radius);
  const float dx = b.x - a.x, dy = b.y - a.y, length2 = dx * dx + dy * dy;
  const uint32_t left = column(std::min(a.x, b.x) - reach), right = column(std::max(a.x, b.x) + reach);
  const uint32_t low = row(std::min(a.y, b.y) - reach), high = row(std::max(a.y, b.y) + reach);
  for (uint32_t r = low; r <= high; ++r) {
    for (uint32_t i = first_[r * columns_ + left]; i < first_[r * columns_ + right + 1]; ++i) {
      const Flat& o = rays_[i].origin;
      const float along = (o.x - a.x) * dx + (o.y - a.y) * dy;
      if ((piece.is_first && along < 0) || (piece.is_last && along > length2)) continue;
      const float t = length2 > 0 ? std::clamp(along / length2, 0.0f, 1.0f) : 0.0f;
      const float radius = piece.begin_radius + t * (piece.end_radius - piece.begin_radius);
      const float off_x = a.x + t * dx - o.x, off_y = a.y + t * dy - o.y;
      const float across = std::sqrt(off_x * off_x + off_y * off_y);
      if (!(across < widen * radius)) continue;
      passes.push_back({rays_[i].index, a.z + t * (b.z - a.z) - o.z, across / radius});
    }
  }
}

}  // namespace pelage
