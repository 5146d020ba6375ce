// SPDX-License-Identifier: Apache-2.0
#include "geom/skin_pieces.h"

#include <algorithm>

#include "base/parallel.h"
#include "geom/skin_lattice.h"
#include "geom/skin_rates.h"

namespace pelage {

namespace {

/// A face of the cage, about where it stands, and what it will cost.
struct CageFace {
  uint32_t face = 0;
  size_t cost = 0;
  V3f middle{0};
};

std::vector<CageFace> cage_faces(const SkinLattice& whole, const LimitSurface& surface) {
  const SurfaceTopology::Impl& topology = surface.topology().impl();
  std::vector<CageFace> faces(topology.cage.face_count());
  for (size_t i = 0; i < whole.face_count(); ++i)
    faces[topology.cage_face[whole.face(i)]].cost += whole.face_triangles(i) + kTrianglesPerPose;
  const float middle = topology.triangular ? 1.0f / 3 : 0.5f;
  for (uint32_t face = 0; face < faces.size(); ++face) {
    faces[face].face = face;
    faces[face].middle = surface.evaluate(topology.cage.first_ptex[face], middle, middle).position;
  }
  return faces;
}

/// Cuts the faces of `range` across their longest side until no piece costs more than `most`, and calls
/// `emit` for each.
template <class Emit>
void cut(std::span<CageFace> range, size_t most, const Emit& emit) {
  size_t all = 0;
  Box3f box;
  for (const CageFace& face : range) {
    all += face.cost;
    box.extendBy(face.middle);
  }
  if (all <= most || range.size() == 1) {
    emit(range);
    return;
  }
  const auto axis = static_cast<int>(box.majorAxis());
  std::sort(range.begin(), range.end(), [axis](const CageFace& a, const CageFace& b) {
    return std::pair(a.middle[axis], a.face) < std::pair(b.middle[axis], b.face);
  });
  // Into parts of whole pieces, so that these become much alike.
  const size_t pieces = (all + most - 1) / most;
  const size_t wanted = all / pieces * (pieces / 2);
  size_t left = 0, count = 0;
  while (count + 1 < range.size() && (count == 0 || left + range[count].cost / 2 < wanted))
    left += range[count++].cost;
  cut(range.first(count), most, emit);
  cut(range.subspan(count), most, emit);
}

}  // namespace

std::vector<SkinPiece> divide_skin(std::span<const LimitSurface> keys, const View& view,
                                   const TessellationOptions& options, size_t most_cost,
                                   const Workers& workers) {
  const SurfaceTopology& topology = keys[0].topology();
  SkinLattice whole(topology.impl());
  set_rates(whole, keys, view, options, workers);
  whole.number();
  std::vector<SkinPiece> pieces;
  const size_t cost = whole.triangle_count() + kTrianglesPerPose * whole.face_count();
  if (cost <= most_cost) {
    pieces.push_back({{}, whole.vertex_count(), whole.triangle_count()});
    return pieces;
  }
  std::vector<CageFace> faces = cage_faces(whole, keys[0]);
  const CageConnectivity& cage = topology.impl().cage;
  cut(std::span(faces), std::max(most_cost, cost / kMostPieces + 1), [&](std::span<const CageFace> part) {
    SkinPiece piece;
    for (const CageFace& face : part) {
      for (uint32_t f = cage.first_ptex[face.face]; f < cage.first_ptex[face.face + 1]; ++f)
        piece.faces.push_back(f);
    }
    std::sort(piece.faces.begin(), piece.faces.end());
    piece.faces.shrink_to_fit();
    pieces.push_back(std::move(piece));
  });
  workers.for_each(pieces.size(), 1, [&](WorkRange range) {
    for (size_t i = range.begin; i < range.end; ++i) {
      SkinLattice lattice(topology.impl(), pieces[i].faces, faces_around(topology, pieces[i].faces));
      lattice.take_rates(whole);
      lattice.number();
      pieces[i].vertices = lattice.vertex_count();
      pieces[i].triangles = lattice.triangle_count();
    }
  });
  return pieces;
}

std::vector<uint32_t> faces_around(const SurfaceTopology& topology, std::span<const uint32_t> faces) {
  const CageConnectivity& cage = topology.impl().cage;
  const auto corners = [&](uint32_t face) {
    return std::span(cage.corner_vertex).subspan(cage.first_corner[face], cage.face_size(face));
  };
  std::vector<bool> touched(topology.control_count());
  for (const uint32_t face : faces) {
    for (const uint32_t vertex : corners(topology.impl().cage_face[face])) touched[vertex] = true;
  }
  std::vector<uint32_t> around;
  for (uint32_t face = 0; face < cage.face_count(); ++face) {
    const auto own = corners(face);
    if (std::none_of(own.begin(), own.end(), [&](uint32_t vertex) { return touched[vertex]; })) continue;
    for (uint32_t f = cage.first_ptex[face]; f < cage.first_ptex[face + 1]; ++f) around.push_back(f);
  }
  return around;
}

std::vector<uint32_t> vertices_of(const SurfaceTopology& topology, std::span<const uint32_t> around) {
  const CageConnectivity& cage = topology.impl().cage;
  std::vector<uint32_t> vertices;
  for (const uint32_t face : around) {
    const uint32_t whole = topology.impl().cage_face[face];
    vertices.insert(vertices.end(), cage.corner_vertex.begin() + cage.first_corner[whole],
                    cage.corner_vertex.begin() + cage.first_corner[whole + 1]);
  }
  std::sort(vertices.begin(), vertices.end());
  vertices.erase(std::unique(vertices.begin(), vertices.end()), vertices.end());
  return vertices;
}

}  // namespace pelage
