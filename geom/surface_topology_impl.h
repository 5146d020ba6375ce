// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <memory>
#include <optional>
#include <vector>

#include <opensubdiv/far/patchMap.h>
#include <opensubdiv/far/patchTable.h>

#include "geom/limit_surface.h"

// What SurfaceTopology is made of, for the sources of geom that evaluate and tessellate. Not for other rooms.

namespace pelage {

namespace Far = OpenSubdiv::Far;

/// Vertices, edges and faces of a cage, for whoever walks over it. Edge i of a face joins its corners i and i
/// + 1.
struct CageConnectivity {
  std::vector<uint32_t> first_corner;  ///< face_count + 1 entries
  std::vector<uint32_t> corner_vertex;
  std::vector<uint32_t> corner_edge;
  std::vector<uint32_t> edge_vertices;  ///< 2 per edge
  std::vector<uint8_t>
      edge_split;  ///< the normals of its faces differ: infinitely sharp, of three faces, or bilinear
  std::vector<uint8_t> vertex_split;  ///< the same, for the faces around a vertex
  std::vector<uint32_t> first_ptex;   ///< face_count + 1 entries: ptex faces of a cage face

  uint32_t face_count() const { return static_cast<uint32_t>(first_ptex.size()) - 1; }
  uint32_t edge_count() const { return static_cast<uint32_t>(edge_split.size()); }
  uint32_t face_size(uint32_t face) const { return first_corner[face + 1] - first_corner[face]; }
  size_t bytes() const;
};

/// How the points of patches follow from control points: each is a weighted sum of points before it, so that
/// one sweep makes them all. Keeping every level's rules apart, instead of multiplying them out to control
/// points, costs a fraction of the memory and does not grow with the square of a pole's valence.
struct PointRules {
  uint32_t control_count = 0;
  std::vector<uint32_t> first_term;  ///< made_count() + 1 entries
  std::vector<uint32_t> source;      ///< of each term: number of the point, control points first
  std::vector<float> weight;

  size_t made_count() const { return first_term.size() - 1; }
  size_t point_count() const { return control_count + made_count(); }
  /// Fills in all points (xyz) behind the control points.
  void apply(float* points) const;
  size_t bytes() const;
};

struct SurfaceTopology::Impl {
  bool triangular = false;  // Loop: ptex faces are triangles
  uint32_t control_count = 0;
  ContentHash hash;
  CageConnectivity cage;

  // One entry per ptex face; of neighbours and uv one per corner as well.
  std::vector<uint32_t> cage_face;
  std::vector<uint8_t> hole;
  std::vector<uint8_t> part;  // one of the n ptex faces of an n-gon
  std::vector<int32_t> neighbours;
  std::vector<V2f> uv;  // empty when the cage has none

  std::unique_ptr<const Far::PatchTable> patches;
  std::optional<Far::PatchMap> patch_map;
  PointRules rules;

  uint32_t corners_per_face() const { return triangular ? 3 : 4; }
};

}  // namespace pelage
