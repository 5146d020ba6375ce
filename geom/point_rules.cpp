// SPDX-License-Identifier: Apache-2.0
#include <bit>

#include "base/check.h"
#include "geom/surface_topology_impl.h"

namespace pelage {
namespace {

// Sums are in double, because rounding accumulates over levels. Two per vector, the last one unused.
using Pair = double __attribute__((vector_size(16)));
struct Point {
  Pair xy, z;
};

Point load_point(const float* p) { return {Pair{p[0], p[1]}, Pair{p[2], 0}}; }
void store(const Point& p, float* out) {
  out[0] = static_cast<float>(p.xy[0]);
  out[1] = static_cast<float>(p.xy[1]);
  out[2] = static_cast<float>(p.z[0]);
}

/// The weighted sum that makes point `made`; `at(i)` is the index of point i in `all`.
template <class At>
Point sum(const PointRules& rules, size_t made, const std::vector<Point>& all, const At& at) {
  Point sum{};
  const PointRules::Terms terms = rules.terms(made);
  for (uint32_t term = 0; term < terms.count; ++term) {
    const Point& p = all[at(terms.source[term])];
    const double w = terms.weight[term];
    sum.xy += p.xy * Pair{w, w};
    sum.z += p.z * Pair{w, w};
  }
  return sum;
}

/// Calls `body(point)` for every needed point, in their order.
template <class Body>
void for_each_point(const PointBlocks& blocks, const Body& body) {
  for (uint32_t block = 0; block < blocks.place.size(); ++block) {
    for (uint32_t left = blocks.wanted[block]; left != 0; left &= left - 1)
      body(block * PointBlocks::kSize + static_cast<uint32_t>(std::countr_zero(left)));
  }
}

}  // namespace

PointRules::Terms PointRules::terms(size_t made) const {
  const uint32_t first = first_term[made], count = first_term[made + 1] - first;
  if (first + count <= source.size()) return {source.data() + first, weight.data() + first, count};
  const size_t local = first - source.size();
  // OpenSubdiv's indices are not negative.
  return {reinterpret_cast<const uint32_t*>(local_source) + local, local_weight + local, count};
}

void PointRules::apply(float* points) const {
  std::vector<Point> all(point_count());
  for (size_t i = 0; i < control_count; ++i) all[i] = load_point(points + i * 3);
  for (size_t i = 0; i < made_count(); ++i) {
    Point& made = all[control_count + i];
    made = sum(*this, i, all, [](uint32_t point) { return point; });
    store(made, points + (control_count + i) * 3);
  }
}

void PointRules::apply(float* points, const PointBlocks& blocks) const {
  std::vector<Point> all(blocks.point_count());
  for_each_point(blocks, [&](uint32_t point) {
    const size_t at = blocks[point];
    if (point < control_count) {
      all[at] = load_point(points + at * 3);
      return;
    }
    all[at] = sum(*this, point - control_count, all, [&](uint32_t p) { return blocks[p]; });
    store(all[at], points + at * 3);
  });
}

size_t PointRules::temporary_bytes(size_t points) { return points * sizeof(Point); }

size_t PointRules::bytes() const {
  return (first_term.capacity() + source.capacity()) * sizeof(uint32_t) + weight.capacity() * sizeof(float);
}

PointBlocks SurfaceTopology::Impl::points_of(std::span<const uint32_t> faces) const {
  PointBlocks blocks;
  const size_t all = (rules.point_count() + PointBlocks::kSize - 1) / PointBlocks::kSize;
  blocks.place.assign(all, PointBlocks::kAbsent);
  blocks.wanted.assign(all, 0);
  std::vector<uint32_t> open;  // made points whose sources have not been visited
  const auto want = [&](uint32_t point) {
    uint16_t& wanted = blocks.wanted[point / PointBlocks::kSize];
    const auto bit = static_cast<uint16_t>(1u << point % PointBlocks::kSize);
    if (wanted & bit) return;
    wanted = static_cast<uint16_t>(wanted | bit);
    if (point >= rules.control_count) open.push_back(point - rules.control_count);
  };
  for (uint32_t face : faces) {
    PELAGE_CHECK(face < cage_face.size());
    if (flat) {
      for (uint32_t corner = 0; corner < 3; ++corner) want(cage.corner_vertex[3 * face + corner]);
      continue;
    }
    for (uint32_t i = first_patch[face]; i < first_patch[face + 1]; ++i) {
      for (int vertex : patches->GetPatchVertices(face_patches[i])) want(static_cast<uint32_t>(vertex));
    }
  }
  while (!open.empty()) {
    const uint32_t made = open.back();
    open.pop_back();
    const PointRules::Terms terms = rules.terms(made);
    for (uint32_t term = 0; term < terms.count; ++term) want(terms.source[term]);
  }
  for (size_t block = 0; block < all; ++block) {
    if (blocks.wanted[block]) blocks.place[block] = blocks.count++;
  }
  return blocks;
}

}  // namespace pelage
