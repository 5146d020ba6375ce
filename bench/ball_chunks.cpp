// SPDX-License-Identifier: Apache-2.0
#include "bench/ball_chunks.h"

#include <algorithm>
#include <numeric>
#include <span>

namespace pelage {
namespace {

void divide(const Strands& batch, std::span<uint32_t> strands, size_t max, size_t first,
            std::vector<size_t>& ends) {
  if (strands.size() <= max) {
    ends.push_back(first + strands.size());
    return;
  }
  const auto root = [&](uint32_t s) { return batch.point(batch.first_point(s)); };
  Box3f box;
  for (uint32_t s : strands) box.extendBy(root(s));
  const auto axis = static_cast<int>(box.majorAxis());
  const size_t half = strands.size() / 2;
  std::nth_element(strands.begin(), strands.begin() + static_cast<std::ptrdiff_t>(half), strands.end(),
                   [&](uint32_t a, uint32_t b) { return root(a)[axis] < root(b)[axis]; });
  divide(batch, strands.first(half), max, first, ends);
  divide(batch, strands.subspan(half), max, first + half, ends);
}

}  // namespace

std::vector<uint32_t> neighbours(const Strands& batch, size_t max, std::vector<size_t>& ends) {
  std::vector<uint32_t> order(batch.strand_count());
  std::iota(order.begin(), order.end(), 0u);
  divide(batch, order, max, 0, ends);
  return order;
}

Strands pick(const Strands& batch, const std::vector<uint32_t>& strands, size_t begin, size_t end) {
  StrandArrays a;
  a.basis = batch.basis();
  a.motion_keys = batch.motion_keys();
  a.first_point.push_back(0);
  for (size_t i = begin; i < end; ++i) {
    a.first_point.push_back(a.first_point.back() + batch.strand_points(strands[i]));
    a.ids.push_back(batch.id(strands[i]));
  }
  for (int key = 0; key < batch.motion_keys(); ++key) {
    for (size_t i = begin; i < end; ++i) {
      const float* p = batch.points(key).data() + size_t(4) * batch.first_point(strands[i]);
      a.points.insert(a.points.end(), p, p + size_t(4) * batch.strand_points(strands[i]));
    }
  }
  return Strands(std::move(a));
}

BallChunks::BallChunks(const BumpyBall& ball, size_t chunk_strands) {
  std::vector<size_t> ends;
  const std::vector<uint32_t> order = neighbours(ball.strands, chunk_strands, ends);
  size_t begin = 0;
  for (size_t end : ends) {
    contents_.push_back({FurContents{pick(ball.strands, order, begin, end), {}}, 0});
    begin = end;
  }
  contents_.push_back({ball.skin, 0});
}

ChunkCounts BallChunks::counts(uint32_t chunk) const {
  ChunkCounts n;
  if (const auto* fur = std::get_if<FurContents>(&contents_[chunk].geometry)) {
    n.strands = fur->strands.strand_count();
    n.points = fur->strands.point_count();
    n.segments = n.points - n.strands;
    n.motion_keys = fur->strands.motion_keys();
  } else {
    const auto& skin = std::get<SkinMesh>(contents_[chunk].geometry);
    n.vertices = skin.vertex_count();
    n.triangles = skin.triangle_count();
    n.motion_keys = skin.motion_keys;
  }
  return n;
}

StrandScale BallChunks::scale(uint32_t) const {
  const auto* fur = std::get_if<FurContents>(&contents_.front().geometry);
  return {fur && fur->strands.point_count() > 0 ? 2 * fur->strands.radius(0) : 0, V3f(0)};
}

}  // namespace pelage
