// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <memory>
#include <optional>
#include <vector>

#include <opensubdiv/far/patchMap.h>
#include <opensubdiv/far/patchTable.h>

#include "geom/limit_surface.h"

// Members of SurfaceTopology. Only for the sources of geom that evaluate and tessellate surfaces.

namespace pelage {

namespace Far = OpenSubdiv::Far;

/// Vertices, edges and faces of a cage, for traversal. Edge i of a face joins its corners i and i + 1.
struct CageConnectivity {
  std::vector<uint32_t> first_corner;   ///< index of the first corner of each face; face_count + 1 entries
  std::vector<uint32_t> corner_vertex;  ///< vertex of each corner
  std::vector<uint32_t> corner_edge;    ///< edge of each corner: from this corner to the next one of the face
  std::vector<uint32_t> edge_vertices;  ///< 2 vertices per edge
  /// 1 if the normals of the adjacent faces differ: at an infinitely sharp edge, at an edge of three faces,
  /// and at every edge between faces with scheme bilinear.
  std::vector<uint8_t> edge_split;
  std::vector<uint8_t> vertex_split;  ///< 1 if the normals of the faces around the vertex differ
  std::vector<uint32_t> first_ptex;   ///< first ptex face of each face; face_count + 1 entries

  uint32_t face_count() const { return static_cast<uint32_t>(first_ptex.size()) - 1; }
  uint32_t edge_count() const { return static_cast<uint32_t>(edge_split.size()); }
  uint32_t face_size(uint32_t face) const { return first_corner[face + 1] - first_corner[face]; }
  size_t bytes() const;
};

/// Tells which points of a large array are kept in a smaller array. Points are kept in blocks of kSize
/// neighbours, so that a short table suffices to find them.
struct PointBlocks {
  static constexpr uint32_t kSize = 16;
  static constexpr uint32_t kAbsent = UINT32_MAX;

  /// For each block of the large array: index among the kept blocks, or kAbsent.
  std::vector<uint32_t> place;
  std::vector<uint16_t> wanted;  ///< for each block of the large array: mask of the points that are needed
  uint32_t count = 0;            ///< number of kept blocks

  /// Returns the index of point `p` in the smaller array. The block of `p` must be kept.
  size_t operator[](uint32_t p) const { return size_t(place[p / kSize]) * kSize + p % kSize; }
  /// Number of points in the smaller array.
  size_t point_count() const { return size_t(count) * kSize; }
};

/// Rules that compute the points of patches from control points. Each point is a weighted sum of points
/// before it, so one pass computes all points. The rules of all subdivision levels are kept. Rules that
/// express each point by control points alone would need several times the memory, which would grow with the
/// square of the valence of a pole.
struct PointRules {
  uint32_t control_count = 0;
  /// The weighted sum that makes one point.
  struct Terms {
    const uint32_t* source;  ///< index of the point of each term; control points come first
    const float* weight;     ///< weight of each term
    uint32_t count;          ///< number of terms
  };

  std::vector<uint32_t> first_term;  ///< index of the first term of each made point; made_count() + 1 entries
  /// Points of the terms that make refined points, which come before local points.
  std::vector<uint32_t> source;
  std::vector<float> weight;  ///< weights of the same terms
  /// Points of the terms that make the local points of patches; owned by the patch table.
  const int* local_source = nullptr;
  const float* local_weight = nullptr;  ///< weights of the same terms

  Terms terms(size_t made) const;

  size_t made_count() const { return first_term.size() - 1; }
  size_t point_count() const { return control_count + made_count(); }
  /// Computes all points after the control points. `points` holds the coordinates xyz of all points.
  void apply(float* points) const;
  /// Computes the needed points of `blocks`, which must include all points that they depend on. `points`
  /// holds the kept blocks only.
  void apply(float* points, const PointBlocks& blocks) const;
  /// Returns the temporary memory of apply() for this number of points.
  static size_t temporary_bytes(size_t points);
  size_t bytes() const;
};

struct SurfaceTopology::Impl {
  bool triangular = false;  // Loop and none: ptex faces are triangles
  bool flat = false;        // scheme none: ptex faces are triangles without patches, each a face of `cage`
  uint32_t control_count = 0;
  ContentHash hash;
  CageConnectivity cage;

  // One entry per ptex face; `neighbours` and `uv` have one entry per corner of each ptex face.
  std::vector<uint32_t> cage_face;
  std::vector<uint8_t> hole;
  std::vector<uint8_t> part;  // 0 for a whole cage face, 1 for one of the n ptex faces of an n-gon
  std::vector<int32_t> neighbours;
  std::vector<V2f> uv;  // empty when the cage has none

  // per vertex of the cage: index of its first entry in `uses`; one more entry at the end
  std::vector<uint32_t> first_use;
  /// The faces that use each vertex, ascending: corner numbers of triangles if `flat`, otherwise faces of the
  /// cage.
  std::vector<uint32_t> uses;

  // Only in a flat topology.
  std::vector<uint32_t> polygon;  // mesh face of each triangle; empty when all mesh faces are triangles

  // Only in a subdivided topology.
  std::unique_ptr<const Far::PatchTable> patches;
  std::optional<Far::PatchMap> patch_map;
  /// First patch of each ptex face, in face_patches; face_count + 1 entries.
  std::vector<uint32_t> first_patch;
  std::vector<Far::PatchTable::PatchHandle> face_patches;
  PointRules rules;

  uint32_t corners_per_face() const { return triangular ? 3 : 4; }
  /// Fills first_use and uses from `cage`.
  void list_uses(uint32_t vertices);
  /// Returns the cage face of an entry of `uses`.
  uint32_t face_of_use(uint32_t use) const { return flat ? use / 3 : use; }
  /// Returns the points that the patches of some faces need, including all points on which those depend.
  PointBlocks points_of(std::span<const uint32_t> faces) const;
};

}  // namespace pelage
