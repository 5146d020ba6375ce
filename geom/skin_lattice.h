// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cstdint>
#include <functional>
#include <limits>
#include <span>
#include <vector>

#include "base/vector.h"
#include "geom/surface_topology_impl.h"

// Topology of a tessellated skin, before vertices have positions. For tessellation.cpp and skin_pieces.cpp.

namespace pelage {

/// A point of a skin, by its parameters.
struct LatticePoint {
  uint32_t face = 0;  ///< ptex face
  V2f uv{0};
};

/// Divides each edge of a cage at a separate rate, and fills the faces with triangles that use the vertices
/// on their edges. Neighbouring faces share these vertices, so no cracks can occur. If a face is split into
/// several ptex faces, its edges are divided into an even number of parts, because two ptex faces share each
/// edge.
///
/// Covers a whole skin or some of its faces. The triangles and vertex positions of a face are the same in
/// both cases.
class SkinLattice {
  using CheckStop = std::function<void()>;
  static constexpr uint32_t kNone = std::numeric_limits<uint32_t>::max();

 public:
  /// A line to be divided: a cage edge, or the spoke from the middle of an n-gon's edge to the n-gon's
  /// centre.
  struct Line {
    uint32_t id = 0;        ///< the cage edge, or edge_count + the ptex face whose side 1 is the spoke
    uint32_t face = kNone;  ///< the first face, not a hole, that has the line or half of it as its side
                            ///< `side`
    uint32_t side = 0;
    bool halved = false;   ///< the line is split by a face with several ptex faces: its rate must be even
    bool is_half = false;  ///< `side` of `face` is one half of the line
    uint32_t rate = 1;
    uint32_t start = 0, end = 0;  ///< vertices
    uint32_t inner = 0;           ///< first of the rate - 1 vertices in between
  };

  /// For all faces. `check_stop` is called every few thousand faces.
  explicit SkinLattice(
      const SurfaceTopology::Impl& topology, const CheckStop& check_stop = [] {});
  /// For some faces only. `faces`: all ptex faces of some cage faces. `around`: these faces and all faces
  /// that touch them (faces_around). Both are ascending.
  SkinLattice(
      const SurfaceTopology::Impl& topology, std::span<const uint32_t> faces,
      std::span<const uint32_t> around, const CheckStop& check_stop = [] {});

  /// The lines of all faces with triangles. Set their rates before number().
  std::vector<Line>& lines() { return lines_; }
  /// Copies the rates from a lattice of all faces.
  void take_rates(const SkinLattice& whole);
  /// Parameters in a face of the point at fraction `t` of its side `side`.
  V2f side_uv(uint32_t side, float t) const;
  /// Numbers vertices and triangles. Throws Error (kMemory) when there are more than fit 31 bits.
  void number(const CheckStop& check_stop = [] {});
  /// Call after number(): assigns a position to every vertex.
  void place();

  size_t vertex_count() const { return vertex_count_; }
  size_t triangle_count() const { return triangle_count_; }
  const std::vector<LatticePoint>& points() const { return points_; }

  /// Number of faces with triangles here, including holes.
  size_t face_count() const { return inside_.size(); }
  /// Ptex face number `i`.
  uint32_t face(size_t i) const { return faces_[inside_[i]].id; }
  size_t face_triangles(size_t i) const {
    return (i + 1 < inside_.size() ? faces_[inside_[i + 1]].triangle : triangle_count_) -
           faces_[inside_[i]].triangle;
  }
  /// Writes the triangles of ptex face number `i` to their positions in a skin's arrays.
  void write_triangles(size_t i, uint32_t* triangles, uint32_t* faces, V2f* uv) const;
  /// For every vertex at which the normals of the adjacent faces differ, calls `visit` for each adjacent
  /// face, in order of faces.
  void visit_split(const std::function<void(uint32_t vertex, const LatticePoint& place)>& visit) const;

  /// Max memory of a lattice with this number of surrounding faces and vertices.
  static size_t bytes_bound(size_t around, size_t vertices);

 private:
  /// A side of a ptex face, counterclockwise: positions base, base + step, ... of a line.
  struct Rail {
    const Line* line = nullptr;
    uint32_t base = 0;
    int step = 1;
    uint32_t rate = 1;
    uint32_t vertex(uint32_t k) const;
  };
  struct Face {
    uint32_t id = 0;               ///< ptex face
    std::array<uint32_t, 4> line;  ///< index into lines_ of each side; kNone: line of no face with triangles
    uint32_t inner = 0;            ///< first inner vertex
    uint32_t triangle = 0;         ///< first triangle
    uint32_t nu = 0;               ///< divisions of the inner lattice; triangular faces have a single number
    uint32_t nv = 0;
  };
  class Writer;

  uint32_t line_id(uint32_t face, uint32_t side) const;
  bool is_edge(uint32_t line_id) const { return line_id < topology_.cage.edge_count(); }
  bool is_part(uint32_t face) const { return topology_.part[face] != 0; }
  bool is_hole(const Face& face) const { return topology_.hole[face.id] != 0; }
  uint32_t corner_vertex(uint32_t face, uint32_t side) const;
  uint32_t place_of(uint32_t cage_vertex) const;
  Rail rail(const Face& face, uint32_t side) const;
  void find_lines(std::span<const uint32_t> faces, const CheckStop& check_stop);
  std::vector<uint32_t> line_ids(std::span<const uint32_t> faces, const CheckStop& check_stop) const;
  void number_line(uint32_t line);
  void divide(Face& face);
  void place_rails(const Face& face);
  void place_inner(const Face& face);
  uint32_t new_points(uint64_t count);

  const SurfaceTopology::Impl& topology_;
  std::vector<Line> lines_;              // ascending by id
  std::vector<uint32_t> cage_vertices_;  // end points of lines_, ascending
  std::vector<uint32_t> numbers_;        // the vertex of each of these
  std::vector<Face> faces_;              // including surrounding ones
  std::vector<uint32_t> inside_;         // indices into faces_ of those with triangles
  std::vector<LatticePoint> points_;
  uint64_t vertex_count_ = 0, triangle_count_ = 0;
};

}  // namespace pelage
