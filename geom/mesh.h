// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <span>
#include <string>
#include <vector>

#include "base/vector.h"

namespace pelage {

/// A control cage as read from an OBJ file. Faces may have any number of corners from 3.
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
  std::vector<uint32_t> face_vertices;  ///< all corners, face by face
  std::vector<V2f> uv;
  std::vector<uint32_t> face_uv;  ///< as face_vertices, into uv; empty when the file has none
  std::vector<Crease> creases;
  std::vector<Corner> corners;
  std::vector<uint32_t> holes;        ///< faces without a surface
  std::vector<uint16_t> face_groups;  ///< index into groups, one per face
  std::vector<std::string> groups;
  bool chaikin_creases = false;   ///< crease sharpness decays by Chaikin's rule ("t creasemethod chaikin")
  bool smooth_triangles = false;  ///< smoother Catmull-Clark rule for triangles ("t smoothtriangles smooth")
  /// "t interpolateboundary": 0 none, 1 edge and corner, 2 edge only; -1 when the file does not state it. The
  /// skin's parameters take precedence; this is for tools that follow the file.
  int boundary_tag = -1;

  size_t face_count() const { return face_sizes.size(); }
  size_t bytes() const;
};

/// The number of distinct vertices of a face, counted up to 3; fewer than 3 make no area.
int distinct_corners(std::span<const uint32_t> face);

}  // namespace pelage
