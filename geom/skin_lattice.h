// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <functional>
#include <vector>

#include "base/vector.h"
#include "geom/surface_topology_impl.h"

// Which vertices and triangles a tessellated skin has, before any of them has a position. For
// tessellation.cpp.

namespace pelage {

/// A point of a skin by its parameters.
struct LatticePoint {
  uint32_t face = 0;  ///< ptex face
  V2f uv{0};
};

/// Divides the edges of a cage, each by a rate of its own, and fills the faces between them with triangles
/// that use the vertices of their edges: neighbours share them, so no crack can open. Edges of a face that is
/// split into several ptex faces are divided evenly, because two of these share each edge.
class SkinLattice {
 public:
  /// What is divided: a cage edge, or the spoke from the middle of an n-gon's edge to the n-gon's centre.
  struct Line {
    uint32_t face = 0;  ///< a ptex face that has the line, or half of it, as its side `side`
    uint32_t side = 0;
    bool used = false;     ///< by a face that is no hole
    bool halved = false;   ///< by a face of several ptex faces: its rate must be even
    bool is_half = false;  ///< `side` of `face` is one half of it
    uint32_t rate = 1;
    uint32_t start = 0, end = 0;  ///< vertices
    uint32_t inner = 0;           ///< first of the rate - 1 vertices between them
  };

  explicit SkinLattice(const SurfaceTopology::Impl& topology);

  /// Set the rate of every line that is used before number().
  std::vector<Line>& lines() { return lines_; }
  /// The piece of a line that its `side` of its `face` is, as parameters of the face at fraction t.
  V2f side_uv(uint32_t side, float t) const;
  /// Numbers vertices and triangles. Throws Error (kMemory) when there are more than 31 bits can number.
  void number();

  size_t vertex_count() const { return points_.size(); }
  size_t triangle_count() const { return triangle_count_; }
  /// A place of every vertex.
  const std::vector<LatticePoint>& points() const { return points_; }
  /// Writes the triangles of a ptex face where they belong in a skin's arrays.
  void write_triangles(uint32_t face, uint32_t* triangles, uint32_t* faces, V2f* uv) const;
  /// Calls `visit` for every vertex and face around it where the normals of its faces differ, in order of
  /// faces.
  void visit_split(const std::function<void(uint32_t vertex, const LatticePoint& place)>& visit) const;

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
    uint32_t inner = 0;     ///< first inner vertex
    uint32_t triangle = 0;  ///< first triangle
    uint32_t nu = 0;        ///< divisions of the inner lattice; triangular faces have one number
    uint32_t nv = 0;
  };
  class Writer;

  uint32_t line_of(uint32_t face, uint32_t side) const;
  bool is_edge(uint32_t line) const { return line < topology_.cage.edge_count(); }
  Rail rail(uint32_t face, uint32_t side) const;
  void number_line(uint32_t line);
  void divide(uint32_t face);
  void place_rails(uint32_t face);
  void place_inner(uint32_t face);
  uint32_t new_points(uint64_t count);

  const SurfaceTopology::Impl& topology_;
  std::vector<Line> lines_;
  std::vector<uint32_t> spoke_;          // line of each ptex face of an n-gon, from the middle of its side 0
  std::vector<uint32_t> cage_vertices_;  // vertex at each vertex of the cage
  std::vector<Face> faces_;
  std::vector<LatticePoint> points_;
  uint64_t triangle_count_ = 0;
};

}  // namespace pelage
