// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <vector>

#include "render/accel/fur/fur_tree.h"

namespace pelage {

/// The fur tree's ribbons by brute force in double precision, on the points that it decodes: every minimum
/// of a segment's distance to the ray's line is found between the roots of derivatives, by halving.
class FurTruth {
 public:
  FurTruth(const SnappedStrands& strands, const Ray& ray) : strands_(strands), ray_(ray) {
    const V3d d = V3d(ray.direction);
    first_ = d.cross(std::abs(d.x) < 0.6 ? V3d(1, 0, 0) : V3d(0, 1, 0)).normalized();
    second_ = d.cross(first_).normalized();
    key_ = 0;
    if (strands.motion_keys() > 1) {
      const double scaled = std::clamp(double(ray.time), 0.0, 1.0) * (strands.motion_keys() - 1);
      key_ = std::min(static_cast<int>(scaled), strands.motion_keys() - 2);
      fraction_ = scaled - key_;
    }
  }

  struct Found {
    double distance = std::numeric_limits<double>::infinity();
    uint32_t number = FurHit::kNone;
    double radius = 0;
  };

  /// The nearest hit of the ray moved sideways by `x` and `y` and forward by `z`, scene units.
  Found closest(double x = 0, double y = 0, double z = 0) const {
    Found best;
    strands_.for_each_segment([&](uint32_t number, SnappedStrands::Place place) {
      each_hit(number, place, {x, y, z}, [&](double distance, double radius) {
        if (distance < best.distance) best = {distance, number, radius};
      });
    });
    return best;
  }

  /// A place on a segment, seen from the ray.
  struct Place {
    double distance = 0;  ///< along the ray
    double beside = 0;    ///< of the ray's line from the axis, less the radius
    double moved = 0;     ///< how far the line has to move at least to be as near as nowhere else around
    double x = 0, y = 0;  ///< where to, as closest() wants it
  };
  Place place_at(uint32_t number, double u) const {
    const Curve curve = seen_from_ray(strands_.locate(number), V3d(0));
    Place place;
    place.distance = value(curve.z, u);
    place.beside = std::hypot(value(curve.x, u), value(curve.y, u)) - value(curve.r, u);
    const double speed = std::hypot(first(curve.x, u), first(curve.y, u));
    if (!(speed > 0)) return place;
    const double along = slope(curve, u) / speed;
    place.moved = std::abs(along);
    place.x = along * first(curve.x, u) / speed;
    place.y = along * first(curve.y, u) / speed;
    return place;
  }

 private:
  /// Ascending roots of a polynomial of the degree kDegree in (low, high): between the roots of its
  /// derivative it has one at most.
  template <size_t kDegree>
  static std::vector<double> roots(const std::array<double, kDegree + 1>& p, double low, double high) {
    std::vector<double> ends{low};
    if constexpr (kDegree > 1) {
      std::array<double, kDegree> derivative;
      for (size_t i = 0; i < kDegree; ++i) derivative[i] = static_cast<double>(i + 1) * p[i + 1];
      const std::vector<double> turns = roots<kDegree - 1>(derivative, low, high);
      ends.insert(ends.end(), turns.begin(), turns.end());
    }
    ends.push_back(high);
    const auto at = [&](double u) {
      double value = 0;
      for (size_t i = kDegree + 1; i-- > 0;) value = value * u + p[i];
      return value;
    };
    std::vector<double> found;
    for (size_t i = 0; i + 1 < ends.size(); ++i) {
      double a = ends[i], b = ends[i + 1];
      const bool below = at(a) < 0;
      if (below == (at(b) < 0)) continue;
      for (int step = 0; step < 60; ++step) {
        const double middle = 0.5 * (a + b);
        ((at(middle) < 0) == below ? a : b) = middle;
      }
      found.push_back(b);
    }
    return found;
  }

  struct Curve {
    double x[4], y[4], z[4], r[4];
  };

  template <class Use>
  void each_hit(uint32_t, SnappedStrands::Place place, const V3d& moved, const Use& use) const {
    const Curve curve = seen_from_ray(place, moved);
    double nearest = 1e300, reach = 0;
    for (int i = 0; i < 4; ++i) {
      nearest = std::min(nearest, std::hypot(curve.x[i], curve.y[i]));
      for (int j = 0; j < 4; ++j) {
        reach = std::max(reach, std::hypot(curve.x[i] - curve.x[j], curve.y[i] - curve.y[j]));
      }
      reach = std::max(reach, curve.r[i]);
    }
    if (nearest > 2 * reach) return;
    // Not at the ends, where a curve has no direction if points coincide there.
    constexpr double kFirst = 1e-9, kLast = 1 - 1e-9;
    // Between the roots of its derivative the slope has one root at most. The slope itself is not taken from
    // its polynomial, which is but noise where the curve comes to rest.
    const std::array<double, 6> polynomial = slope_polynomial(curve);
    std::array<double, 5> derivative;
    for (size_t i = 0; i < 5; ++i) derivative[i] = static_cast<double>(i + 1) * polynomial[i + 1];
    std::vector<double> places{kFirst};
    for (const double rotation : roots<4>(derivative, kFirst, kLast)) places.push_back(rotation);
    places.push_back(kLast);
    for (size_t i = 0; i + 1 < places.size(); ++i) {
      double low = places[i], high = places[i + 1];
      if (!(slope(curve, low) < 0 && slope(curve, high) >= 0)) continue;
      for (int step = 0; step < 60; ++step) {
        const double middle = 0.5 * (low + high);
        (slope(curve, middle) < 0 ? low : high) = middle;
      }
      const double radius = value(curve.r, high), distance = value(curve.z, high);
      if (std::hypot(value(curve.x, high), value(curve.y, high)) < radius && distance > ray_.near &&
          distance < ray_.far) {
        use(distance, radius);
      }
    }
  }

  Curve seen_from_ray(SnappedStrands::Place place, const V3d& moved) const {
    Curve curve;
    const double step = strands_.grid().step();
    const SnappedSegment a = strands_.segment(place, key_);
    const SnappedSegment b = fraction_ > 0 ? strands_.segment(place, key_ + 1) : a;
    for (size_t i = 0; i < 4; ++i) {
      double p[4];
      for (size_t j = 0; j < 4; ++j) p[j] = step * ((1 - fraction_) * a[i][j] + fraction_ * b[i][j]);
      const V3d relative = V3d(strands_.grid().anchor()) - V3d(ray_.origin) + V3d(p[0], p[1], p[2]);
      curve.x[i] = relative.dot(first_) - moved.x;
      curve.y[i] = relative.dot(second_) - moved.y;
      curve.z[i] = relative.dot(V3d(ray_.direction)) / V3d(ray_.direction).length2() - moved.z;
      curve.r[i] = p[3];
    }
    return curve;
  }

  static double value(const double (&p)[4], double u) {
    const double s = 1 - u;
    return s * s * s * p[0] + 3 * s * s * u * p[1] + 3 * s * u * u * p[2] + u * u * u * p[3];
  }
  static double first(const double (&p)[4], double u) {
    const double s = 1 - u;
    return s * s * (p[1] - p[0]) + 2 * s * u * (p[2] - p[1]) + u * u * (p[3] - p[2]);
  }
  static std::array<double, 6> slope_polynomial(const Curve& c) {
    std::array<double, 6> result{};
    for (const auto& p : {c.x, c.y}) {
      const double power[4] = {p[0], 3 * (p[1] - p[0]), 3 * (p[2] - 2 * p[1] + p[0]),
                               p[3] - 3 * p[2] + 3 * p[1] - p[0]};
      for (size_t i = 0; i < 4; ++i) {
        for (size_t j = 1; j < 4; ++j) result[i + j - 1] += static_cast<double>(j) / 3 * power[i] * power[j];
      }
    }
    return result;
  }
  static double slope(const Curve& c, double u) {
    return value(c.x, u) * first(c.x, u) + value(c.y, u) * first(c.y, u);
  }

  const SnappedStrands& strands_;
  const Ray& ray_;
  V3d first_{0}, second_{0};
  int key_ = 0;
  double fraction_ = 0;
};

}  // namespace pelage
