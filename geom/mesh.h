// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <span>
#include <string>
#include <vector>

#include "base/hash.h"
#include "base/vector.h"

namespace pelage {

/// A control cage as read from an OBJ file. A face has three or more corners.
struct ControlMesh {
  struct Crease {
    uint32_t a = 0, b = 0;  ///< vertices at the ends of the edge
    float sharpness = 0;
  };
  struct Corner {
    uint32_t vertex = 0;
    float sharpness = 0;
  };

  std::vector<V3f> positions;
  std::vector<uint32_t> face_sizes;     ///< number of corners of each face
  std::vector<uint32_t> face_vertices;  ///< vertex of each corner, face by face
  std::vector<V2f> uv;
  /// Index into `uv` of each corner, face by face; empty when the file has no texture coordinates.
  std::vector<uint32_t> face_uv;
  std::vector<Crease> creases;
  std::vector<Corner> corners;
  std::vector<uint32_t> holes;        ///< faces without a surface
  std::vector<uint16_t> face_groups;  ///< index into `groups` of each face
  std::vector<std::string> groups;    ///< names
  /// Objects or materials of an OBJ file; empty when the file has none.
  struct FaceNames {
    std::vector<uint16_t> faces;  ///< index into `names` of each face
    std::vector<std::string> names;
  };
  FaceNames objects, materials;
  std::vector<Rgb> colors;       ///< linear colour of each vertex; empty when the file has none
  bool chaikin_creases = false;  ///< crease sharpness decays by Chaikin's rule ("t creasemethod chaikin")
  /// Smoother weights for triangles in Catmull-Clark subdivision ("t smoothtriangles smooth").
  bool smooth_triangles = false;
  /// Value of "t interpolateboundary": 0 none, 1 edge and corner, 2 edge only; -1 when the file does not
  /// state it. The parameters of a skin override this value; only tools that follow the file use it.
  int boundary_tag = -1;

  size_t face_count() const { return face_sizes.size(); }
  size_t bytes() const;
};

/// Removes each face that has the same vertices as an earlier face, in any order: exporters of two-sided
/// surfaces write each face twice. The earlier face is a hole only if all of them are. Returns the number of
/// removed faces. Needs 16 temporary bytes per face. Leaves a mesh alone whose arrays do not fit each other.
size_t merge_equal_faces(ControlMesh& mesh);

/// What a mesh and its poses must have in common: poses are positions without names.
struct MeshOrder {
  size_t vertices = 0;
  ContentHash faces;  ///< of the vertices of each face: content_hash() of their counts and numbers, in order
};
MeshOrder mesh_order(const ControlMesh& mesh);

/// Returns the number of distinct vertices of a face, but at most 3. A face with fewer than 3 has no area.
int distinct_corners(std::span<const uint32_t> face);

}  // namespace pelage
