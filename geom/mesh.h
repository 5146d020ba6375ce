// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <span>
#include <string>
#include <vector>

#include "base/vector.h"

namespace pelage {

/// A control cage as an OBJ file gives it. Faces of any number of corners from 3.
struct ControlMesh {
  struct Crease {
    uint32_t a = 0, b = 0;  ///< vertices of an edge
    float sharpness = 0;
  };
  struct Corner {
    uint32_t vertex = 0;
    float sharpness = 0;
  };

  std::vector<V3f> positions;
  std::vector<uint32_t> face_sizes;
  std::vector<uint32_t> face_vertices;  ///< all corners, face after face
  std::vector<V2f> uv;
  std::vector<uint32_t> face_uv;  ///< as face_vertices, into uv; empty when the file has none
  std::vector<Crease> creases;
  std::vector<Corner> corners;
  std::vector<uint32_t> holes;        ///< faces that leave no surface
  std::vector<uint16_t> face_groups;  ///< index into groups, one per face
  std::vector<std::string> groups;
  bool chaikin_creases = false;   ///< crease sharpness decays by Chaikin's rule ("t creasemethod chaikin")
  bool smooth_triangles = false;  ///< Catmull-Clark rounds triangles better ("t smoothtriangles smooth")
  /// "t interpolateboundary": 0 none, 1 edge and corner, 2 edge only; -1 when the file does not say. What the
  /// skin asks for decides; this is for tools that follow the file.
  int boundary_tag = -1;

  size_t face_count() const { return face_sizes.size(); }
  size_t bytes() const;
};

/// Whether a face is more than a line: its corners that are not the vertex of a corner before, counted up
/// to 3.
int distinct_corners(std::span<const uint32_t> face);

}  // namespace pelage
