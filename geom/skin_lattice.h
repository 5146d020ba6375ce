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

// Topology of a tessellated skin: which vertices and triangles it has, without positions in space. For
// tessellation.cpp and skin_pieces.cpp.

namespace pelage {

/// A point of a skin, given by a face and parameters.
struct LatticePoint {
  uint32_t face = 0;  ///< ptex face
  V2f uv{0};
};

/// Divides each edge of a cage at its own rate, and fills the faces with triangles that use the vertices on
/// their edges. Neighbouring faces share these vertices, so no cracks can occur. The rate of an edge is the
/// number of parts into which it is divided. If a face beside the edge consists of several ptex faces, the
/// rate is even, because two of these ptex faces share the edge.
///
/// Covers a whole skin or some of its faces. A face has the same triangles and vertex positions in both
/// cases.
class SkinLattice {
  using CheckStop = std::function<void()>;
  static constexpr uint32_t kNone = std::numeric_limits<uint32_t>::max();

 public:
  /// A line to be divided: a cage edge, or the spoke from the middle of an n-gon's edge to the n-gon's
  /// centre.
  struct Line {
    /// The index of the cage edge; for a spoke, edge_count + the ptex face whose side 1 is the spoke.
    uint32_t id = 0;
    uint32_t face = kNone;  ///< the first face, not a hole, one of whose sides is the line or half of it
    uint32_t side = 0;      ///< that side of `face`
    bool halved = false;    ///< a face with several ptex faces halves the line, so its rate must be even
    bool is_half = false;   ///< `side` of `face` is one half of the line instead of the whole line
    uint32_t rate = 1;      ///< number of parts into which the line is divided
    uint32_t start = 0, end = 0;  ///< vertices at the ends
    uint32_t inner = 0;           ///< first of the rate - 1 vertices between the ends
  };

  /// Makes a lattice of all faces. Calls `check_stop` every few thousand faces.
  explicit SkinLattice(
      const SurfaceTopology::Impl& topology, const CheckStop& check_stop = [] {});
  /// Makes a lattice of some faces. `faces`: all ptex faces of some cage faces. `around`:
  /// faces_around(faces), which are these faces and all faces that touch them. Both lists must be ascending.
  SkinLattice(
      const SurfaceTopology::Impl& topology, std::span<const uint32_t> faces,
      std::span<const uint32_t> around, const CheckStop& check_stop = [] {});

  /// The lines of all faces that have triangles in this lattice. Set their rates before number().
  std::vector<Line>& lines() { return lines_; }
  /// Copies the rates of all lines from `whole`, a lattice of all faces.
  void take_rates(const SkinLattice& whole);
  /// Returns the parameters in a face of the point at fraction `t` of the face's side `side`.
  V2f side_uv(uint32_t side, float t) const;
  /// Assigns indices to vertices and triangles. Throws Error (kMemory) when there are more than 2^31 - 1 of
  /// either.
  void number(const CheckStop& check_stop = [] {});
  /// Sets points(): the face and parameters of every vertex. Call after number().
  void place();

  size_t vertex_count() const { return vertex_count_; }
  size_t triangle_count() const { return triangle_count_; }
  const std::vector<LatticePoint>& points() const { return points_; }

  /// Number of faces that this lattice covers, without faces that only touch them. Includes holes.
  size_t face_count() const { return inside_.size(); }
  /// Returns the ptex face with index `i` among the covered faces.
  uint32_t face(size_t i) const { return faces_[inside_[i]].id; }
  /// Returns the number of triangles of covered face `i`.
  size_t face_triangles(size_t i) const {
    return (i + 1 < inside_.size() ? faces_[inside_[i + 1]].triangle : triangle_count_) -
           faces_[inside_[i]].triangle;
  }
  /// Writes the triangles of covered face `i` to their places in the arrays of a SkinMesh.
  void write_triangles(size_t i, uint32_t* triangles, uint32_t* faces, V2f* uv) const;
  /// Calls `visit` for every vertex at which the normals of the adjacent faces differ: once for each adjacent
  /// face, in ascending order of faces. `place` is the vertex's point in that face.
  void visit_split(const std::function<void(uint32_t vertex, const LatticePoint& place)>& visit) const;

  /// Returns the max memory of a lattice with `around` faces, including those that touch the covered faces,
  /// and this number of vertices.
  static size_t bytes_bound(size_t around, size_t vertices);

 private:
  /// A side of a ptex face, counterclockwise. Its points have the indices base, base + step, ...
  struct Rail {
    const Line* line = nullptr;
    uint32_t base = 0;
    int step = 1;
    uint32_t rate = 1;
    uint32_t vertex(uint32_t k) const;
  };
  struct Face {
    uint32_t id = 0;               ///< ptex face
    std::array<uint32_t, 4> line;  ///< index into lines_ of each side; kNone: no covered face has this line
    uint32_t inner = 0;            ///< first inner vertex
    uint32_t triangle = 0;         ///< first triangle
    uint32_t nu = 0;  ///< divisions of the inner lattice in u; for triangular faces, in both directions
    uint32_t nv = 0;  ///< divisions of the inner lattice in v
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
  std::vector<uint32_t> cage_vertices_;  // cage vertices at the ends of lines_, ascending
  std::vector<uint32_t> numbers_;        // vertex index of each of the cage_vertices_
  std::vector<Face> faces_;              // covered faces and those that touch them
  std::vector<uint32_t> inside_;         // indices into faces_ of the covered faces
  std::vector<LatticePoint> points_;
  uint64_t vertex_count_ = 0, triangle_count_ = 0;
};

}  // namespace pelage
