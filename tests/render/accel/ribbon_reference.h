// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <algorithm>
#include <cmath>
#include <vector>

#include "geom/curve.h"
#include "render/accel/accel.h"

namespace pelage {

/// A place where a ray passes a strand within 1.3 radii.
struct Passage {
  double distance = 0;  ///< along the ray, to the axis
  double h = 0;
  double v = 0;  ///< over the whole strand
  double radius = 0;
  size_t strand = 0;
  double slant = 0;         ///< |cosine| between ray and strand
  double from_joint = 0.5;  ///< of a segment, in parameter

  bool is_hit() const { return std::abs(h) < 1; }
  /// Too near an edge or an end, or seen too much along the strand, for two methods of finite precision to
  /// agree.
  bool is_marginal() const {
    return (std::abs(h) > 0.8 && std::abs(h) < 1.2) || v < 0.02 || v > 0.98 || slant > 0.9;
  }
};

/// Ray-facing ribbons by brute force, in double precision: walks along every strand in small steps and
/// refines each local minimum of the distance between curve and ray.
class RibbonReference {
 public:
  RibbonReference(const Strands& strands, const Ray& ray) : strands_(strands), ray_(ray) {}

  /// All passages in front of the ray's origin, nearest first.
  std::vector<Passage> passages() const {
    std::vector<Passage> found;
    for (size_t s = 0; s < strands_.strand_count(); ++s) {
      if (passes_far_from(s)) continue;
      const int steps = kSteps * static_cast<int>(segment_count(strands_.basis(), strands_.strand_points(s)));
      std::vector<double> d;
      for (int i = 0; i <= steps; ++i) d.push_back(at(s, double(i) / steps).distance_to_ray);
      for (double end : {0.0, 1.0}) {
        const Point point = at(s, end);
        if (point.distance_to_ray < 1.3 * point.radius)
          found.push_back({point.depth, 1, end, point.radius, s, 0, 0});
      }
      for (size_t i = 1; i + 1 < d.size(); ++i) {
        if (d[i] <= d[i - 1] && d[i] < d[i + 1]) {
          add_minimum(s, double(i - 1) / steps, double(i + 1) / steps, found);
        }
      }
    }
    std::sort(found.begin(), found.end(),
              [](const Passage& a, const Passage& b) { return a.distance < b.distance; });
    return found;
  }

 private:
  static constexpr int kSteps = 12;

  struct Point {
    V3d offset{0};  ///< from the ray to the axis, perpendicular to the ray
    double distance_to_ray = 0, depth = 0, radius = 0;
    V3d tangent{0};
  };

  /// Whether the ray misses a sphere that holds the strand with much to spare.
  bool passes_far_from(size_t strand) const {
    const V3f centre = strands_.point(strands_.first_point(strand));
    float reach = 0;
    for (int key = 0; key < strands_.motion_keys(); ++key) {
      for (uint32_t i = 0; i < strands_.strand_points(strand); ++i) {
        const size_t point = strands_.first_point(strand) + i;
        reach =
            std::max(reach, (strands_.point(point, key) - centre).length() + 2 * strands_.radius(point, key));
      }
    }
    return (centre - ray_.origin).cross(ray_.direction).length() > 1.5f * reach;
  }

  Point at(size_t strand, double v) const {
    const uint32_t count = segment_count(strands_.basis(), strands_.strand_points(strand));
    const double whole = std::min(std::floor(v * count), count - 1.0);
    const double u = v * count - whole, w = 1 - u;
    const CubicSegment segment = bezier_segment_at(strands_, strand, static_cast<uint32_t>(whole), ray_.time);
    Point point;
    V3d position(0);
    const double weights[4] = {w * w * w, 3 * w * w * u, 3 * w * u * u, u * u * u};
    for (size_t i = 0; i < 4; ++i) {
      position += weights[i] * V3d(segment.p[i]);
      point.radius += weights[i] * segment.r[i];
    }
    const V3d relative = position - V3d(ray_.origin);
    point.depth = relative.dot(V3d(ray_.direction));
    point.offset = relative - point.depth * V3d(ray_.direction);
    point.distance_to_ray = point.offset.length();
    point.tangent = V3d(curve_tangent(segment, static_cast<float>(u)));
    return point;
  }

  void add_minimum(size_t strand, double low, double high, std::vector<Passage>& found) const {
    for (int step = 0; step < 30; ++step) {
      const double a = low + (high - low) * 0.382, b = low + (high - low) * 0.618;
      if (at(strand, a).distance_to_ray < at(strand, b).distance_to_ray) {
        high = b;
      } else {
        low = a;
      }
    }
    const double v = 0.5 * (low + high);
    const Point point = at(strand, v);
    if (point.depth <= 0 || point.distance_to_ray > 1.3 * point.radius) return;
    // The ray passes at axis - h r ez, so that -offset = -h r ez.
    const V3d ez = point.tangent.cross(-V3d(ray_.direction)).normalized();
    const double slant = std::abs(point.tangent.normalized().dot(V3d(ray_.direction)));
    const double place = v * segment_count(strands_.basis(), strands_.strand_points(strand));
    found.push_back({point.depth, point.offset.dot(ez) / point.radius, v, point.radius, strand, slant,
                     std::abs(place - std::round(place))});
  }

  const Strands& strands_;
  const Ray& ray_;
};

}  // namespace pelage
