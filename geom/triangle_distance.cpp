// SPDX-License-Identifier: Apache-2.0
#include "geom/triangle_distance.h"

#include <algorithm>
#include <cmath>
#include <limits>

namespace pelage {

namespace {

constexpr float kTiny = std::numeric_limits<float>::min();

/// Squared distances from the origin to the edges a b.
Four edge_distances(const FourVectors& a, const FourVectors& b) {
  const FourVectors edge = b - a;
  const Four along = -a.dot(edge) / larger(edge.dot(edge), four(kTiny));
  const FourVectors nearest = a + edge * smaller(larger(along, four(0)), four(1));
  return nearest.dot(nearest);
}

/// Squared distances to the feet of the perpendiculars from the origin, where these lie within the triangles;
/// infinite elsewhere.
Four face_distances(const FourVectors& a, const FourVectors& b, const FourVectors& c) {
  const FourVectors normal = (b - a).cross(c - a);
  // Areas separated by the foot, times twice the total area.
  const Four wa = normal.dot(b.cross(c)), wb = normal.dot(c.cross(a)), wc = normal.dot(a.cross(b));
  const Four sum = wa + wb + wc;
  const FourVectors foot = (a * wa + b * wb + c * wc) * (four(1) / larger(sum, four(kTiny)));
  // Where the sum is tiny, the triangle has no interior.
  const auto within = (smaller(smaller(wa, wb), wc) >= four(0)) & (sum > four(kTiny));
  return within ? foot.dot(foot) : four(std::numeric_limits<float>::infinity());
}

}  // namespace

Four packet_distances(const TrianglePacket& packet, const V3f& point) {
  const FourVectors origin{four(point.x), four(point.y), four(point.z)};
  const FourVectors a = packet.corner[0] - origin, b = packet.corner[1] - origin,
                    c = packet.corner[2] - origin;
  const Four edges = smaller(smaller(edge_distances(a, b), edge_distances(b, c)), edge_distances(c, a));
  return smaller(edges, face_distances(a, b, c));
}

V3d Triangle::normal() const {
  const V3d n = (corner[1] - corner[0]).cross(corner[2] - corner[0]);
  const double length = n.length();
  return length > 0 ? n / length : V3d(0);
}

double Triangle::angle(size_t i) const {
  const V3d a = corner[(i + 1) % 3] - corner[i], b = corner[(i + 2) % 3] - corner[i];
  return std::atan2(a.cross(b).length(), a.dot(b));
}

NearestOnTriangle nearest_on_triangle(const Triangle& triangle, const V3d& point) {
  using Feature = NearestOnTriangle::Feature;
  const V3d n = (triangle.corner[1] - triangle.corner[0]).cross(triangle.corner[2] - triangle.corner[0]);
  const V3d to[3] = {triangle.corner[0] - point, triangle.corner[1] - point, triangle.corner[2] - point};
  V3d weights(n.dot(to[1].cross(to[2])), n.dot(to[2].cross(to[0])), n.dot(to[0].cross(to[1])));
  const double sum = weights.x + weights.y + weights.z;
  const auto finish = [&](const V3d& w, Feature feature, uint32_t corner) {
    const V3d& c0 = triangle.corner[0];
    const V3d position = c0 + (triangle.corner[1] - c0) * w.y + (triangle.corner[2] - c0) * w.z;
    return NearestOnTriangle{position, w, feature, corner};
  };
  if (sum > 0 && std::min({weights.x, weights.y, weights.z}) > 0)
    return finish(weights / sum, Feature::kFace, 0);

  NearestOnTriangle best;
  double nearest = std::numeric_limits<double>::infinity();
  for (uint32_t i = 0; i < 3; ++i) {
    const uint32_t j = (i + 1) % 3;
    const V3d edge = triangle.corner[j] - triangle.corner[i];
    const double length2 = edge.length2();
    const double t = length2 > 0 ? std::clamp(-to[i].dot(edge) / length2, 0.0, 1.0) : 0.0;
    const double distance = (to[i] + edge * t).length2();
    if (distance >= nearest) continue;
    nearest = distance;
    V3d w(0);
    w[static_cast<int>(i)] = 1 - t;
    w[static_cast<int>(j)] = t;
    best = finish(w, t > 0 && t < 1 ? Feature::kEdge : Feature::kVertex, t < 1 ? i : j);
  }
  return best;
}

}  // namespace pelage
