// SPDX-License-Identifier: Apache-2.0
#include "geom/strand_point.h"

#include <algorithm>
#include <cmath>

#include "geom/curve.h"

namespace pelage {
namespace {

/// Weights of four consecutive points of a strand.
struct Weights {
  float w[4];
};

Weights b_spline_weights(float t) {
  const float u = 1 - t, t2 = t * t, t3 = t2 * t;
  constexpr float kSixth = 1.0f / 6;
  return {
      {kSixth * u * u * u, kSixth * (3 * t3 - 6 * t2 + 4), kSixth * (3 * (t + t2 - t3) + 1), kSixth * t3}};
}
Weights b_spline_derivative(float t) {
  const float u = 1 - t;
  return {{-0.5f * u * u, t * (1.5f * t - 2), 0.5f + t - 1.5f * t * t, 0.5f * t * t}};
}
Weights catmull_rom_weights(float t) {
  const float t2 = t * t, t3 = t2 * t;
  return {{0.5f * (-t3 + 2 * t2 - t), 0.5f * (3 * t3 - 5 * t2 + 2), 0.5f * (-3 * t3 + 4 * t2 + t),
           0.5f * (t3 - t2)}};
}
Weights catmull_rom_derivative(float t) {
  const float t2 = t * t;
  return {{0.5f * (-3 * t2 + 4 * t - 1), 0.5f * (9 * t2 - 10 * t), 0.5f * (-9 * t2 + 8 * t + 1),
           0.5f * (3 * t2 - 2 * t)}};
}

Weights bezier_weights(float t) {
  const float u = 1 - t;
  return {{u * u * u, 3 * (u * u * t), 3 * (u * t * t), t * t * t}};
}
Weights bezier_derivative(float t) {
  const float u = 1 - t, ut = 2 * (u * t);
  return {{-3 * (u * u), 3 * (u * u - ut), 3 * (ut - t * t), 3 * (t * t)}};
}

/// Points first .. first + 3 of a strand, of which `before` at the front and `after` at the back do not
/// exist: a phantom point 2 P0 - P1 is folded into the weights of P0 and P1.
struct Window {
  size_t first = 0;  ///< index of the first existing point
  int count = 4;     ///< number of existing points
  bool phantom_before = false, phantom_after = false;

  Window(const Strands& strands, size_t strand, uint32_t segment) {
    first = strands.first_point(strand) + segment;
    if (strands.basis() == CurveBasis::kBSpline) return;
    if (strands.basis() == CurveBasis::kBezier) {
      first += size_t(2) * segment;
      return;
    }
    if (strands.basis() == CurveBasis::kLinear) {
      count = 2;
      return;
    }
    phantom_before = segment == 0;
    phantom_after = segment + 2 == strands.strand_points(strand);
    count = 4 - phantom_before - phantom_after;
    if (!phantom_before) --first;
  }

  /// Weights of the existing points, from the weights of all four.
  Weights fold(Weights all) const {
    float* w = all.w;
    if (phantom_before) {
      w[1] += 2 * w[0];
      w[2] -= w[0];
    }
    if (phantom_after) {
      w[2] += 2 * w[3];
      w[1] -= w[3];
    }
    if (phantom_before) {
      for (int i = 0; i < 3; ++i) w[i] = w[i + 1];
    }
    return all;
  }
};

/// Sum of weighted points, x y z radius, at one motion key.
struct Sum {
  float c[4] = {0, 0, 0, 0};

  void add(const float* points, const Weights& weights, int count, float scale) {
    for (int i = 0; i < count; ++i) {
      const float w = scale * weights.w[i];
      for (int k = 0; k < 4; ++k) c[k] += w * points[4 * i + k];
    }
  }
  V3f vector() const { return {c[0], c[1], c[2]}; }
};

/// A weighted sum over the points of a window at a shutter time.
Sum weighted_points(const Strands& strands, const Window& window, const Weights& weights, float time) {
  Sum sum;
  const auto points = [&](int key) { return &strands.points(key)[4 * window.first]; };
  if (strands.motion_keys() == 1) {
    sum.add(points(0), weights, window.count, 1);
    return sum;
  }
  const float scaled = std::clamp(time, 0.0f, 1.0f) * static_cast<float>(strands.motion_keys() - 1);
  const int key = std::min(static_cast<int>(scaled), strands.motion_keys() - 2);
  const float after = scaled - static_cast<float>(key);
  sum.add(points(key), weights, window.count, 1 - after);
  sum.add(points(key + 1), weights, window.count, after);
  return sum;
}

Weights position_weights(CurveBasis basis, float t) {
  if (basis == CurveBasis::kLinear) return {{1 - t, t, 0, 0}};
  if (basis == CurveBasis::kBezier) return bezier_weights(t);
  return basis == CurveBasis::kCatmullRom ? catmull_rom_weights(t) : b_spline_weights(t);
}
Weights derivative_weights(CurveBasis basis, float t) {
  if (basis == CurveBasis::kLinear) return {{-1, 1, 0, 0}};
  if (basis == CurveBasis::kBezier) return bezier_derivative(t);
  return basis == CurveBasis::kCatmullRom ? catmull_rom_derivative(t) : b_spline_derivative(t);
}

V3f unit_tangent(const Strands& strands, size_t strand, uint32_t segment, const Window& window, float t,
                 float time) {
  const V3f d =
      weighted_points(strands, window, window.fold(derivative_weights(strands.basis(), t)), time).vector();
  const float length2 = d.length2();
  // Nearly zero: where the curve has no derivative, curve_tangent() determines its direction.
  const float* p = &strands.points()[4 * window.first];
  const V3f step(p[4] - p[0], p[5] - p[1], p[6] - p[2]);
  if (!(length2 > 1e-8f * step.length2()) || length2 < 1e-30f) {
    return curve_tangent(bezier_segment_at(strands, strand, segment, time), t).normalized();
  }
  return d * (1 / std::sqrt(length2));
}

}  // namespace

StrandPoint strand_point(const Strands& strands, size_t strand, uint32_t segment, float t, float time) {
  const Window window(strands, strand, segment);
  const Sum at = weighted_points(strands, window, window.fold(position_weights(strands.basis(), t)), time);
  return {at.vector(), std::max(at.c[3], 0.0f), unit_tangent(strands, strand, segment, window, t, time)};
}

V3f strand_tangent(const Strands& strands, size_t strand, float v, float time) {
  const uint32_t count = segment_count(strands.basis(), strands.strand_points(strand));
  const float scaled = std::clamp(v, 0.0f, 1.0f) * static_cast<float>(count);
  const uint32_t segment = std::min(static_cast<uint32_t>(scaled), count - 1);
  const Window window(strands, strand, segment);
  return unit_tangent(strands, strand, segment, window, scaled - static_cast<float>(segment), time);
}

}  // namespace pelage
