// SPDX-License-Identifier: Apache-2.0
#include "geom/skin_pieces.h"

#include <algorithm>

#include "base/job.h"
#include "geom/skin_lattice.h"
#include "geom/skin_rates.h"

namespace pelage {

namespace {

/// A face of the cage, its approximate position, and its cost.
struct CageFace {
  uint32_t face = 0;
  size_t cost = 0;
  V3f middle{0};
};

void sort_without_repeats(std::vector<uint32_t>& values) {
  std::sort(values.begin(), values.end());
  values.erase(std::unique(values.begin(), values.end()), values.end());
}

std::vector<CageFace> cage_faces(const SkinLattice& whole, const LimitSurface& surface, const Job& job) {
  constexpr size_t kFacesAtOnce = 4096;
  const SurfaceTopology::Impl& topology = surface.topology().impl();
  std::vector<CageFace> faces(topology.cage.face_count());
  for (size_t i = 0; i < whole.face_count(); ++i)
    faces[topology.cage_face[whole.face(i)]].cost += whole.face_triangles(i) + kTrianglesPerPose;
  const float middle = topology.triangular ? 1.0f / 3 : 0.5f;
  job.for_each(faces.size(), kFacesAtOnce, [&](WorkRange range) {
    for (auto face = static_cast<uint32_t>(range.begin); face < range.end; ++face) {
      faces[face].face = face;
      faces[face].middle = surface.evaluate(topology.cage.first_ptex[face], middle, middle).position;
    }
  });
  return faces;
}

/// Number of faces of `range`, in order of one coordinate, with a total cost of about `wanted`: at least one,
/// and not all. These are moved to the front. Each step halves the unsorted range: linear in total.
size_t split_off(std::span<CageFace> range, int axis, size_t wanted, const Job& job) {
  const auto before = [axis](const CageFace& a, const CageFace& b) {
    return std::pair(a.middle[axis], a.face) < std::pair(b.middle[axis], b.face);
  };
  const auto at = [&](size_t i) { return range.begin() + static_cast<std::ptrdiff_t>(i); };
  std::nth_element(at(0), at(0), at(range.size()), before);
  size_t low = 1, high = range.size() - 1, left = range[0].cost;  // cost of those before `low`
  while (low < high) {
    job.check_stop();
    const size_t middle = low + (high - low) / 2;
    std::nth_element(at(low), at(middle), at(high), before);
    size_t sum = left;
    for (size_t i = low; i < middle; ++i) sum += range[i].cost;
    if (sum + range[middle].cost / 2 < wanted) {
      left = sum + range[middle].cost;
      low = middle + 1;
    } else {
      high = middle;
    }
  }
  return low;
}

/// Number of faces of a range to cut off across its longest side; all if the range costs no more than `max`.
size_t cut(std::span<CageFace> range, size_t max, const Job& job) {
  size_t all = 0;
  Box3f box;
  for (const CageFace& face : range) {
    all += face.cost;
    box.extendBy(face.middle);
  }
  if (all <= max || range.size() == 1) return range.size();
  // Into multiples of whole pieces, so that pieces have similar costs.
  const size_t pieces = (all + max - 1) / max;
  return split_off(range, static_cast<int>(box.majorAxis()), all / pieces * (pieces / 2), job);
}

/// Cuts the faces until no part costs more than `max`. Parts are in order from one side to the other.
std::vector<std::span<CageFace>> cut_all(std::span<CageFace> faces, size_t max, const Job& job) {
  std::vector<std::span<CageFace>> done, open{faces};
  while (!open.empty()) {
    std::vector<size_t> counts(open.size());
    job.for_each(open.size(), 1, [&](WorkRange range) {
      for (size_t i = range.begin; i < range.end; ++i) counts[i] = cut(open[i], max, job);
    });
    std::vector<std::span<CageFace>> next;
    for (size_t i = 0; i < open.size(); ++i) {
      if (counts[i] == open[i].size()) {
        done.push_back(open[i]);
      } else {
        next.push_back(open[i].first(counts[i]));
        next.push_back(open[i].subspan(counts[i]));
      }
    }
    open = std::move(next);
  }
  std::sort(done.begin(), done.end(), [](const auto& a, const auto& b) { return a.data() < b.data(); });
  return done;
}

/// The piece of some faces of the cage.
SkinPiece piece_of(std::span<const CageFace> part, const SurfaceTopology& topology,
                   const SkinLattice& whole) {
  const CageConnectivity& cage = topology.impl().cage;
  SkinPiece piece;
  for (const CageFace& face : part) {
    for (uint32_t f = cage.first_ptex[face.face]; f < cage.first_ptex[face.face + 1]; ++f)
      piece.faces.push_back(f);
  }
  std::sort(piece.faces.begin(), piece.faces.end());
  piece.faces.shrink_to_fit();
  SkinLattice lattice(topology.impl(), piece.faces, faces_around(topology, piece.faces));
  lattice.take_rates(whole);
  lattice.number();
  piece.vertices = lattice.vertex_count();
  piece.triangles = lattice.triangle_count();
  return piece;
}

}  // namespace

std::vector<SkinPiece> divide_skin(std::span<const LimitSurface> keys, const View& view,
                                   const TessellationOptions& options, size_t max_cost, const Job& job) {
  const SurfaceTopology& topology = keys[0].topology();
  const auto check_stop = [&job] { job.check_stop(); };
  SkinLattice whole(topology.impl(), check_stop);
  set_rates(whole, keys, view, options, job.workers, check_stop);
  whole.number(check_stop);
  const size_t cost = whole.triangle_count() + kTrianglesPerPose * whole.face_count();
  if (cost <= max_cost) return {{{}, whole.vertex_count(), whole.triangle_count()}};
  std::vector<CageFace> faces = cage_faces(whole, keys[0], job);
  const std::vector<std::span<CageFace>> parts =
      cut_all(faces, std::max(max_cost, cost / kMaxPieces + 1), job);
  std::vector<SkinPiece> pieces(parts.size());
  job.for_each(parts.size(), 1, [&](WorkRange range) {
    for (size_t i = range.begin; i < range.end; ++i) pieces[i] = piece_of(parts[i], topology, whole);
  });
  return pieces;
}

std::vector<uint32_t> faces_around(const SurfaceTopology& topology, std::span<const uint32_t> faces) {
  const SurfaceTopology::Impl& impl = topology.impl();
  const CageConnectivity& cage = impl.cage;
  std::vector<uint32_t> whole;  // faces of the cage
  for (const uint32_t vertex : vertices_of(topology, faces)) {
    for (uint32_t use = impl.first_use[vertex]; use < impl.first_use[vertex + 1]; ++use)
      whole.push_back(impl.face_of_use(impl.uses[use]));
  }
  sort_without_repeats(whole);
  std::vector<uint32_t> around;
  for (const uint32_t face : whole) {
    for (uint32_t f = cage.first_ptex[face]; f < cage.first_ptex[face + 1]; ++f) around.push_back(f);
  }
  return around;
}

std::vector<uint32_t> vertices_of(const SurfaceTopology& topology, std::span<const uint32_t> around) {
  const CageConnectivity& cage = topology.impl().cage;
  std::vector<uint32_t> vertices;
  uint32_t last = UINT32_MAX;  // faces of one polygon are consecutive
  for (const uint32_t face : around) {
    const uint32_t whole = topology.impl().cage_face[face];
    if (whole == last) continue;
    last = whole;
    vertices.insert(vertices.end(), cage.corner_vertex.begin() + cage.first_corner[whole],
                    cage.corner_vertex.begin() + cage.first_corner[whole + 1]);
  }
  sort_without_repeats(vertices);
  return vertices;
}

}  // namespace pelage
