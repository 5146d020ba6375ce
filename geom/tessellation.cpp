// SPDX-License-Identifier: Apache-2.0
#include "geom/tessellation.h"

#include <algorithm>
#include <cmath>

#include "base/check.h"
#include "base/job.h"
#include "base/parallel.h"
#include "geom/skin_lattice.h"
#include "geom/skin_pieces.h"
#include "geom/skin_rates.h"

namespace pelage {

namespace {

constexpr size_t kFacesAtOnce = 64;
constexpr size_t kPointsPerTask = 1024;

/// Parallel loops, with a check before each range.
struct Loops {
  const Workers& workers;
  const Job* job = nullptr;  // null: cannot be stopped

  void check_stop() const {
    if (job) job->check_stop();
  }
  template <class Body>
  void for_each(size_t count, size_t grain, const Body& body) const {
    workers.for_each(count, grain, [&](WorkRange range) {
      check_stop();
      body(range);
    });
  }
};

/// Normalised sums of the normals of all faces around each vertex where they differ.
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
    // Faces back to back have no common normal: the first one's is kept.
    if (sum.length() > 1e-3f) std::copy_n(&(sum.normalize().x), 3, &normals[size_t(vertex) * 3]);
  }
}

SkinMesh fill(const SkinLattice& lattice, std::span<const LimitSurface> keys, const Loops& loops) {
  SkinMesh mesh;
  mesh.motion_keys = static_cast<int>(keys.size());
  const size_t triangles = lattice.triangle_count();
  mesh.triangles.resize(triangles * 3);
  mesh.faces.resize(triangles);
  mesh.vertex_uv.resize(triangles * 3);
  loops.for_each(lattice.face_count(), kFacesAtOnce, [&](WorkRange range) {
    for (size_t i = range.begin; i < range.end; ++i)
      lattice.write_triangles(i, mesh.triangles.data(), mesh.faces.data(), mesh.vertex_uv.data());
  });

  const std::vector<LatticePoint>& points = lattice.points();
  mesh.positions.resize(points.size() * 3 * keys.size());
  mesh.normals.resize(mesh.positions.size());
  for (size_t key = 0; key < keys.size(); ++key) {
    float* positions = mesh.positions.data() + key * points.size() * 3;
    float* normals = mesh.normals.data() + key * points.size() * 3;
    loops.for_each(points.size(), kPointsPerTask, [&](WorkRange range) {
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

SkinMesh tessellate_all(std::span<const LimitSurface> keys, const View& view,
                        const TessellationOptions& options, const Loops& loops) {
  PELAGE_CHECK(!keys.empty());
  const auto check_stop = [&loops] { loops.check_stop(); };
  SkinLattice lattice(keys[0].topology().impl(), check_stop);
  set_rates(lattice, keys, view, options, loops.workers, check_stop);
  lattice.number(check_stop);
  lattice.place();
  return fill(lattice, keys, loops);
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

SkinMesh tessellate(std::span<const LimitSurface> keys, const View& view, const TessellationOptions& options,
                    const Workers& workers) {
  return tessellate_all(keys, view, options, {workers});
}

SkinMesh tessellate(std::span<const LimitSurface> keys, const View& view, const TessellationOptions& options,
                    const Job& job) {
  return tessellate_all(keys, view, options, {job.workers, &job});
}

SkinMesh tessellate_faces(std::span<const LimitSurface> keys, std::span<const uint32_t> faces,
                          const View& view, const TessellationOptions& options) {
  PELAGE_CHECK(!keys.empty());
  const SurfaceTopology& topology = keys[0].topology();
  SkinLattice lattice(topology.impl(), faces, faces_around(topology, faces));
  set_rates(lattice, keys, view, options, Workers::alone());
  lattice.number();
  lattice.place();
  return fill(lattice, keys, {Workers::alone()});
}

size_t tessellating_bytes(const SurfaceTopology& topology, size_t faces, size_t vertices) {
  const std::vector<uint8_t>& split = topology.impl().cage.vertex_split;
  const bool any = std::find(split.begin(), split.end(), uint8_t(1)) != split.end();
  // In addition to the lattice: the faces themselves, and split normals, about four per such vertex, in a
  // vector that grows by doubling and is sorted with a temporary copy.
  return SkinLattice::bytes_bound(faces, vertices) + faces * 2 * sizeof(uint32_t) +
         (any ? vertices * 12 * sizeof(std::pair<uint32_t, V3f>) : 0);
}

}  // namespace pelage
