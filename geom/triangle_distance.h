// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>

#include "base/vector.h"
#include "geom/four_lanes.h"

namespace pelage {

/// Four triangles side by side.
struct TrianglePacket {
  FourVectors corner[3];
  uint32_t triangle[4];  ///< their numbers
};

/// Squared distances from a point to four triangles. Each is the distance to an actual point of the triangle,
/// even of a degenerate one, and so, except for rounding, never smaller than the exact distance.
Four packet_distances(const TrianglePacket& packet, const V3f& point);

struct Triangle {
  V3d corner[3];

  /// Unit normal, counterclockwise from outside; zero when the triangle has no area.
  V3d normal() const;
  /// Angle at a corner, radians.
  double angle(size_t corner) const;
};

/// The point of a triangle nearest to a given point, and whether it is inside, on an edge or at a corner.
struct NearestOnTriangle {
  enum class Feature { kFace, kEdge, kVertex };
  V3d position{0};
  V3d weights{0};  ///< of the corners, sum 1
  Feature feature = Feature::kFace;
  uint32_t corner = 0;  ///< the vertex, or the first vertex of the edge
};
NearestOnTriangle nearest_on_triangle(const Triangle& triangle, const V3d& point);

}  // namespace pelage
