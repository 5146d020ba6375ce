// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>

#include "base/vector.h"
#include "geom/four_lanes.h"

namespace pelage {

/// Four triangles for SIMD, one per lane.
struct TrianglePacket {
  FourVectors corner[3];
  uint32_t triangle[4];  ///< index of each triangle
};

/// Returns the squared distances from a point to four triangles. Each is the distance to a point that lies on
/// the triangle, even if the triangle is degenerate. Except for rounding, it is therefore never smaller than
/// the exact distance.
Four packet_distances(const TrianglePacket& packet, const V3f& point);

struct Triangle {
  V3d corner[3];

  /// Unit normal; its direction is such that the corners run counterclockwise when seen from outside. 0 when
  /// the triangle has no area.
  V3d normal() const;
  /// Angle at a corner in radians.
  double angle(size_t corner) const;
};

/// The point of a triangle that is nearest to a given point. `feature` tells whether it is inside the
/// triangle, on an edge or at a corner.
struct NearestOnTriangle {
  enum class Feature { kFace, kEdge, kVertex };
  V3d position{0};
  V3d weights{0};  ///< barycentric weights of the corners, sum 1
  Feature feature = Feature::kFace;
  uint32_t corner = 0;  ///< for kVertex: the corner; for kEdge: the first corner of the edge; for kFace: 0
};
NearestOnTriangle nearest_on_triangle(const Triangle& triangle, const V3d& point);

}  // namespace pelage
