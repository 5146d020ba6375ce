// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <memory>
#include <optional>
#include <vector>

#include <opensubdiv/far/patchMap.h>
#include <opensubdiv/far/patchTable.h>

#include "geom/limit_surface.h"

// Members of SurfaceTopology, for the sources of geom that evaluate and tessellate. Not for other rooms.

namespace pelage {

namespace Far = OpenSubdiv::Far;

/// Vertices, edges and faces of a cage, for traversal. Edge i of a face joins its corners i and i + 1.
struct CageConnectivity {
  std::vector<uint32_t> first_corner;  ///< face_count + 1 entries
  std::vector<uint32_t> corner_vertex;
  std::vector<uint32_t> corner_edge;
  std::vector<uint32_t> edge_vertices;  ///< 2 per edge
  std::vector<uint8_t> edge_split;  ///< the normals of its faces differ: an infinitely sharp edge, an edge of
                                    ///< three faces, or scheme bilinear
  std::vector<uint8_t> vertex_split;  ///< the same, for the faces around a vertex
  std::vector<uint32_t> first_ptex;   ///< face_count + 1 entries: ptex faces of a cage face

  uint32_t face_count() const { return static_cast<uint32_t>(first_ptex.size()) - 1; }
  uint32_t edge_count() const { return static_cast<uint32_t>(edge_split.size()); }
  uint32_t face_size(uint32_t face) const { return first_corner[face + 1] - first_corner[face]; }
  size_t bytes() const;
};

/// A subset of points, in blocks of neighbours, so that a short table locates them.
struct PointBlocks {
  static constexpr uint32_t kSize = 16;
  static constexpr uint32_t kAbsent = UINT32_MAX;

  std::vector<uint32_t> place;  ///< for each block of all points: its index among the kept blocks, or kAbsent
  std::vector<uint16_t> wanted;  ///< for each block of all points: mask of its needed points
  uint32_t count = 0;            ///< number of kept blocks

  /// Index of point `p` among the kept points, if its block is kept.
  size_t operator[](uint32_t p) const { return size_t(place[p / kSize]) * kSize + p % kSize; }
  size_t point_count() const { return size_t(count) * kSize; }
};

/// Rules that compute the points of patches from control points: each is a weighted sum of previous points,
/// so that one sweep computes them all. Keeping the rules of each level, instead of composing them down to
/// control points, needs a fraction of the memory and does not grow with the square of a pole's valence.
struct PointRules {
  uint32_t control_count = 0;
  /// One of the weighted sums.
  struct Terms {
    const uint32_t* source;  ///< of each term: point number, control points first
    const float* weight;
    uint32_t count;
  };

  std::vector<uint32_t> first_term;   ///< made_count() + 1 entries
  std::vector<uint32_t> source;       ///< of the terms of refined points, which come first
  std::vector<float> weight;          ///< the same
  const int* local_source = nullptr;  ///< of the following terms, in the patches
  const float* local_weight = nullptr;

  Terms terms(size_t made) const;

  size_t made_count() const { return first_term.size() - 1; }
  size_t point_count() const { return control_count + made_count(); }
  /// Computes all points (xyz) after the control points.
  void apply(float* points) const;
  /// The same for the needed points of `blocks`, which must include all points that they depend on. `points`
  /// holds the kept blocks.
  void apply(float* points, const PointBlocks& blocks) const;
  /// Temporary memory of apply() for this number of points.
  static size_t temporary_bytes(size_t points);
  size_t bytes() const;
};

struct SurfaceTopology::Impl {
  bool triangular = false;  // Loop and none: ptex faces are triangles
  bool flat = false;        // none: the triangles themselves, without patches; each is a face of `cage`
  uint32_t control_count = 0;
  ContentHash hash;
  CageConnectivity cage;

  // One entry per ptex face; neighbours and uv have one per corner as well.
  std::vector<uint32_t> cage_face;
  std::vector<uint8_t> hole;
  std::vector<uint8_t> part;  // one of the n ptex faces of an n-gon
  std::vector<int32_t> neighbours;
  std::vector<V2f> uv;  // empty when the cage has none

  std::vector<uint32_t> first_use;  // per vertex of the cage, plus one: start of its entries in `uses`
  /// Ascending for each vertex: corner numbers of flat triangles, otherwise faces of the cage.
  std::vector<uint32_t> uses;

  // Only in a flat topology.
  std::vector<uint32_t> polygon;  // mesh face that each triangle was cut from; empty when all are triangles

  // Only in a subdivided topology.
  std::unique_ptr<const Far::PatchTable> patches;
  std::optional<Far::PatchMap> patch_map;
  std::vector<uint32_t> first_patch;  ///< face_count + 1 entries: patches of a ptex face
  std::vector<Far::PatchTable::PatchHandle> face_patches;
  PointRules rules;

  uint32_t corners_per_face() const { return triangular ? 3 : 4; }
  /// Fills first_use and uses from `cage`.
  void list_uses(uint32_t vertices);
  /// The cage face of an entry of `uses`.
  uint32_t face_of_use(uint32_t use) const { return flat ? use / 3 : use; }
  /// The points of the patches of some faces, and all points that they depend on.
  PointBlocks points_of(std::span<const uint32_t> faces) const;
};

}  // namespace pelage
