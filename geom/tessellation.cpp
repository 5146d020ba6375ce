// SPDX-License-Identifier: Apache-2.0
#include "geom/tessellation.h"

#include <algorithm>
#include <cmath>

#include "base/check.h"
#include "base/parallel.h"
#include "geom/skin_lattice.h"

namespace pelage {

namespace {

constexpr size_t kLinesAtOnce = 256;
constexpr size_t kFacesAtOnce = 64;
constexpr size_t kPointsAtOnce = 1024;

/// Pieces that a line must be cut into so that none looks longer than asked for, in any of the poses.
uint32_t line_rate(const SkinLattice::Line& line, const SkinLattice& lattice,
                   std::span<const LimitSurface> keys, const View& view, const TessellationOptions& options) {
  float pixels = 0;
  for (const LimitSurface& surface : keys) {
    V3f p[3];
    float scale = 0;
    for (int i = 0; i < 3; ++i) {
      const V2f uv = lattice.side_uv(line.side, 0.5f * static_cast<float>(i));
      p[i] = surface.evaluate(line.face, uv.x, uv.y).position;
      scale = std::max(scale, view.pixels_per_unit(p[i]));
    }
    pixels = std::max(pixels, ((p[1] - p[0]).length() + (p[2] - p[1]).length()) * scale);
  }
  if (line.is_half) pixels *= 2;
  const auto most = static_cast<float>(std::max(options.max_rate, line.halved ? 2 : 1));
  const float wanted = std::ceil(pixels / options.edge_pixels);
  auto rate = static_cast<uint32_t>(wanted < most ? std::max(wanted, 1.0f) : most);
  if (line.halved && rate % 2 != 0) rate += static_cast<float>(rate + 1) <= most ? 1 : -1;
  return rate;
}

/// Unit sums of the normals of all faces around each vertex at which they differ.
void average_split_normals(const SkinLattice& lattice, const LimitSurface& surface, float* normals) {
  std::vector<std::pair<uint32_t, V3f>> shares;
  lattice.visit_split([&](uint32_t vertex, const LatticePoint& place) {
    shares.emplace_back(vertex, surface.frame(place.face, place.uv.x, place.uv.y).normal);
  });
  std::stable_sort(shares.begin(), shares.end(),
                   [](const auto& a, const auto& b) { return a.first < b.first; });
  for (size_t i = 0; i < shares.size();) {
    const uint32_t vertex = shares[i].first;
    V3f sum(0);
    for (; i < shares.size() && shares[i].first == vertex; ++i) sum += shares[i].second;
    // Faces back to back have no normal in common: that of the first stays.
    if (sum.length() > 1e-3f) std::copy_n(&(sum.normalize().x), 3, &normals[size_t(vertex) * 3]);
  }
}

/// How the skin will be cut, every vertex numbered.
SkinLattice numbered_lattice(std::span<const LimitSurface> keys, const View& view,
                             const TessellationOptions& options, const Workers& workers) {
  PELAGE_CHECK(!keys.empty());
  const SurfaceTopology& topology = keys[0].topology();
  for (const LimitSurface& key : keys) PELAGE_CHECK(&key.topology() == &topology);
  const size_t end = std::min(options.end_rated_key, keys.size());
  PELAGE_CHECK(options.first_rated_key < end);
  const auto rated = keys.subspan(options.first_rated_key, end - options.first_rated_key);

  SkinLattice lattice(topology.impl());
  std::vector<SkinLattice::Line>& lines = lattice.lines();
  workers.for_each(lines.size(), kLinesAtOnce, [&](WorkRange range) {
    for (size_t i = range.begin; i < range.end; ++i) {
      if (lines[i].used) lines[i].rate = line_rate(lines[i], lattice, rated, view, options);
    }
  });
  lattice.number();
  return lattice;
}

}  // namespace

size_t SkinMesh::bytes() const {
  return (positions.capacity() + normals.capacity()) * sizeof(float) +
         (triangles.capacity() + faces.capacity()) * sizeof(uint32_t) + vertex_uv.capacity() * sizeof(V2f);
}

void SkinMesh::assign_triangle(const SkinMesh& source, size_t triangle) {
  motion_keys = source.motion_keys;
  positions.clear();
  normals.clear();
  for (int key = 0; key < motion_keys; ++key) {
    const size_t first = static_cast<size_t>(key) * source.vertex_count();
    for (size_t corner = 0; corner < 3; ++corner) {
      const size_t at = 3 * (first + source.triangles[3 * triangle + corner]);
      positions.insert(positions.end(), &source.positions[at], &source.positions[at] + 3);
      normals.insert(normals.end(), &source.normals[at], &source.normals[at] + 3);
    }
  }
  triangles.assign({0, 1, 2});
  faces.assign({source.faces[triangle]});
  const auto uv = source.vertex_uv.begin() + static_cast<std::ptrdiff_t>(3 * triangle);
  vertex_uv.assign(uv, uv + 3);
}

TessellationSize tessellation_size(std::span<const LimitSurface> keys, const View& view,
                                   const TessellationOptions& options, const Workers& workers) {
  const SkinLattice lattice = numbered_lattice(keys, view, options, workers);
  return {lattice.points().size(), lattice.triangle_count()};
}

SkinMesh tessellate(std::span<const LimitSurface> keys, const View& view, const TessellationOptions& options,
                    const Workers& workers) {
  const SkinLattice lattice = numbered_lattice(keys, view, options, workers);

  SkinMesh mesh;
  mesh.motion_keys = static_cast<int>(keys.size());
  const size_t triangles = lattice.triangle_count();
  mesh.triangles.resize(triangles * 3);
  mesh.faces.resize(triangles);
  mesh.vertex_uv.resize(triangles * 3);
  workers.for_each(keys[0].topology().face_count(), kFacesAtOnce, [&](WorkRange range) {
    for (size_t face = range.begin; face < range.end; ++face) {
      lattice.write_triangles(static_cast<uint32_t>(face), mesh.triangles.data(), mesh.faces.data(),
                              mesh.vertex_uv.data());
    }
  });

  const std::vector<LatticePoint>& points = lattice.points();
  mesh.positions.resize(points.size() * 3 * keys.size());
  mesh.normals.resize(mesh.positions.size());
  for (size_t key = 0; key < keys.size(); ++key) {
    float* positions = mesh.positions.data() + key * points.size() * 3;
    float* normals = mesh.normals.data() + key * points.size() * 3;
    workers.for_each(points.size(), kPointsAtOnce, [&](WorkRange range) {
      for (size_t i = range.begin; i < range.end; ++i) {
        const auto& [face, uv] = points[i];
        const SurfacePoint p = keys[key].evaluate(face, uv.x, uv.y);
        std::copy_n(&p.position.x, 3, positions + i * 3);
        const V3f normal = keys[key].frame(p, face, uv.x, uv.y).normal;
        std::copy_n(&normal.x, 3, normals + i * 3);
      }
    });
    average_split_normals(lattice, keys[key], normals);
  }
  return mesh;
}

}  // namespace pelage
