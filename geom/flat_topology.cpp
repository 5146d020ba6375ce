// SPDX-License-Identifier: Apache-2.0
#include "geom/flat_topology.h"

#include <algorithm>
#include <cmath>
#include <numeric>

#include "base/release.h"
#include "geom/polygon_cut.h"

namespace pelage {

namespace {

constexpr size_t kFacesPerCheck = 4096;

/// The triangles of a mesh, as consecutive corner numbers of its faces, with the face that each was cut from.
struct CutMesh {
  std::vector<uint32_t> corners;
  std::vector<uint32_t> faces;  // empty when every face is a triangle
};

CutMesh cut_faces(const ControlMesh& mesh, const std::function<void()>& check_stop) {
  CutMesh cut;
  cut.corners.reserve(3 * flat_triangle_count(mesh));
  const bool all_triangles =
      std::all_of(mesh.face_sizes.begin(), mesh.face_sizes.end(), [](uint32_t size) { return size == 3; });
  if (all_triangles) {
    cut.corners.resize(mesh.face_vertices.size());
    std::iota(cut.corners.begin(), cut.corners.end(), 0u);
    return cut;
  }
  cut.faces.reserve(flat_triangle_count(mesh));
  std::vector<V3f> positions;
  uint32_t first = 0;
  size_t corners_since_check = 0;
  for (uint32_t face = 0; face < mesh.face_sizes.size(); ++face) {
    const uint32_t size = mesh.face_sizes[face];
    const auto vertices = std::span(mesh.face_vertices).subspan(first, size);
    positions.clear();
    for (const uint32_t vertex : vertices) positions.push_back(mesh.positions[vertex]);
    const size_t begin = cut.corners.size();
    cut_polygon(vertices, positions, cut.corners);
    for (size_t i = begin; i < cut.corners.size(); ++i) cut.corners[i] += first;
    cut.faces.resize(cut.corners.size() / 3, face);
    first += size;
    corners_since_check += size_t(size) * size;
    if (corners_since_check < kFacesPerCheck * 16) continue;
    corners_since_check = 0;
    check_stop();
  }
  return cut;
}

/// Side `i` of a triangle, numbered consecutively; its ends.
struct Side {
  uint32_t other = 0;  // the end with the higher number
  uint32_t side = 0;
};

/// Lists every side at its lower-numbered vertex, so that the sides of one edge are adjacent, in order of
/// faces.
class SidesByVertex {
 public:
  SidesByVertex(const std::vector<uint32_t>& corner_vertex, size_t vertices) : first_(vertices + 1) {
    const auto ends = [&](uint32_t side) {
      const uint32_t next = side % 3 == 2 ? side - 2 : side + 1;
      return std::minmax(corner_vertex[side], corner_vertex[next]);
    };
    const auto sides = static_cast<uint32_t>(corner_vertex.size());
    for (uint32_t side = 0; side < sides; ++side) ++first_[ends(side).first + 1];
    for (size_t v = 1; v < first_.size(); ++v) first_[v] += first_[v - 1];
    sides_.resize(sides);
    std::vector<uint32_t> next(first_.begin(), first_.end() - 1);
    for (uint32_t side = 0; side < sides; ++side) {
      const auto [low, high] = ends(side);
      sides_[next[low]++] = {high, side};
    }
  }

  /// Calls `edge(low, high, sides)` for every edge.
  template <class Visit>
  void visit(const Visit& edge) {
    for (uint32_t low = 0; low + 1 < first_.size(); ++low) {
      const auto own = std::span(sides_).subspan(first_[low], first_[low + 1] - first_[low]);
      std::sort(own.begin(), own.end(), [](const Side& a, const Side& b) {
        return a.other != b.other ? a.other < b.other : a.side < b.side;
      });
      for (size_t begin = 0, end = 0; begin < own.size(); begin = end) {
        while (end < own.size() && own[end].other == own[begin].other) ++end;
        edge(low, own[begin].other, own.subspan(begin, end - begin));
      }
    }
  }

 private:
  std::vector<uint32_t> first_;
  std::vector<Side> sides_;
};

void connect(size_t vertices, SurfaceTopology::Impl& impl) {
  CageConnectivity& cage = impl.cage;
  cage.corner_edge.resize(cage.corner_vertex.size());
  impl.neighbours.assign(cage.corner_vertex.size(), -1);
  SidesByVertex sides(cage.corner_vertex, vertices);
  uint32_t edges = 0;
  // Most edges join two triangles.
  cage.edge_vertices.reserve(cage.corner_vertex.size() + cage.corner_vertex.size() / 16);
  sides.visit([&](uint32_t low, uint32_t high, std::span<const Side> around) {
    for (const Side& side : around) cage.corner_edge[side.side] = edges;
    if (around.size() == 2) {
      impl.neighbours[around[0].side] = static_cast<int32_t>(around[1].side / 3);
      impl.neighbours[around[1].side] = static_cast<int32_t>(around[0].side / 3);
    }
    cage.edge_vertices.push_back(low);
    cage.edge_vertices.push_back(high);
    ++edges;
  });
  cage.edge_split.assign(edges, 0);
  cage.vertex_split.assign(vertices, 0);
}

}  // namespace

size_t flat_triangle_count(const ControlMesh& mesh) {
  return mesh.face_vertices.size() - 2 * mesh.face_sizes.size();
}

void fill_flat_topology(const ControlMesh& mesh, const std::function<void()>& check_stop,
                        SurfaceTopology::Impl& impl) {
  impl.flat = impl.triangular = true;
  CutMesh cut = cut_faces(mesh, check_stop);
  const auto count = static_cast<uint32_t>(cut.corners.size() / 3);
  CageConnectivity& cage = impl.cage;
  cage.corner_vertex.resize(cut.corners.size());
  std::transform(cut.corners.begin(), cut.corners.end(), cage.corner_vertex.begin(),
                 [&](uint32_t corner) { return mesh.face_vertices[corner]; });
  if (!mesh.face_uv.empty()) {
    impl.uv.resize(cut.corners.size());
    std::transform(cut.corners.begin(), cut.corners.end(), impl.uv.begin(),
                   [&](uint32_t corner) { return mesh.uv[mesh.face_uv[corner]]; });
  }
  release(cut.corners);
  // Each triangle is a face of its own.
  cage.first_corner.resize(count + 1);
  cage.first_ptex.resize(count + 1);
  for (uint32_t i = 0; i <= count; ++i) {
    cage.first_corner[i] = 3 * i;
    cage.first_ptex[i] = i;
  }
  impl.cage_face.resize(count);
  std::iota(impl.cage_face.begin(), impl.cage_face.end(), 0u);
  impl.part.assign(count, 0);
  check_stop();
  connect(mesh.positions.size(), impl);
  check_stop();
  impl.list_uses(impl.control_count);

  std::vector<bool> hole(mesh.face_sizes.size());
  for (const uint32_t face : mesh.holes) hole[face] = true;
  impl.hole.resize(count);
  for (uint32_t i = 0; i < count; ++i) impl.hole[i] = hole[cut.faces.empty() ? i : cut.faces[i]];
  if (!cut.faces.empty()) {
    // The triangulation of faces depends on more than their corners.
    impl.hash = ContentHasher().add(impl.hash).add(std::span<const uint32_t>(cage.corner_vertex)).digest();
  }
  impl.polygon = std::move(cut.faces);
  impl.rules.control_count = impl.control_count;
  impl.rules.first_term.push_back(0);
}

size_t flat_bytes(size_t triangles, size_t vertices, bool has_uv) {
  const size_t edges = 3 * triangles;  // if no two triangles share one
  return sizeof(SurfaceTopology::Impl) +
         triangles * (3 * sizeof(uint32_t) + 2 +                                        // per triangle
                      4 * 3 * sizeof(uint32_t) + (has_uv ? 3 * sizeof(V2f) : 0) + 4) +  // per corner
         edges * (2 * sizeof(uint32_t) + 1) +
         vertices * (sizeof(uint32_t) + 1);
}

size_t flat_temporary_bytes(size_t triangles, size_t vertices, bool has_uv) {
  return flat_bytes(triangles, vertices, has_uv) + triangles * 3 * sizeof(Side) +
         vertices * 2 * sizeof(uint32_t);
}

V3f flat_vertex_normal(const SurfaceTopology::Impl& impl, std::span<const V3f> positions, uint32_t vertex) {
  const std::vector<uint32_t>& corner_vertex = impl.cage.corner_vertex;
  V3d sum(0);
  const V3d here(positions[vertex]);
  for (uint32_t i = impl.first_use[vertex]; i < impl.first_use[vertex + 1]; ++i) {
    const uint32_t corner = impl.uses[i], first = corner - corner % 3;
    const V3d a = V3d(positions[corner_vertex[first + (corner + 1) % 3]]) - here;
    const V3d b = V3d(positions[corner_vertex[first + (corner + 2) % 3]]) - here;
    const V3d normal = a.cross(b);
    const double length = normal.length();
    if (length > 0 && std::isfinite(length)) sum += normal * (std::atan2(length, a.dot(b)) / length);
  }
  // For an angle of 1: sums far below are rounding of normals that cancel.
  return sum.length() > 1e-6 ? V3f(sum.normalized()) : V3f(0);
}

}  // namespace pelage
