// SPDX-License-Identifier: Apache-2.0
#include "render/accel/fur/fur_folds.h"

#include <algorithm>
#include <array>
#include <cmath>

namespace pelage {
namespace {

constexpr int kMaxHalvings = 20;  // number of halvings
// Newton's method; then every other step is a bisection, which ends at the limit of rounding (see
// fur_curves.inl).
constexpr int kNewtonSteps = 16, kMaxRootSteps = kNewtonSteps + 2 * 22;
constexpr float kNearRoots = 0x1p-22f;  // in the parameter

/// c . c' / 3 over a part of the curve, as Bernstein coefficients times ten over binomials.
using Quintic = std::array<float, 6>;

Quintic distance_derivative(const PlaneCurve& curve) {
  const auto product = [&](size_t point, size_t difference) {
    return curve.x[point] * curve.dx[difference] + curve.y[point] * curve.dy[difference];
  };
  return {product(0, 0),
          (2 * product(0, 1) + 3 * product(1, 0)) / 5,
          (product(0, 2) + 6 * product(1, 1) + 3 * product(2, 0)) / 10,
          (3 * product(1, 2) + 6 * product(2, 1) + product(3, 0)) / 10,
          (3 * product(2, 2) + 2 * product(3, 1)) / 5,
          curve.end_x * curve.dx[2] + curve.end_y * curve.dy[2]};
}

struct FoldPart {
  Quintic f;
  float begin, end;
  int depth;
  bool flat_begin, flat_end;  // the curve's own ends, where points coincide

  void halve(FoldPart& left, FoldPart& right) const {
    Quintic row = f;
    const float middle = 0.5f * (begin + end);
    left = {{}, begin, middle, depth + 1, flat_begin, false};
    right = {{}, middle, end, depth + 1, false, flat_end};
    for (size_t i = 0; i < 6; ++i) {
      left.f[i] = row[0];
      right.f[5 - i] = row[5 - i];
      for (size_t j = 0; j + 1 < 6 - i; ++j) row[j] = 0.5f * (row[j] + row[j + 1]);
    }
  }
  /// Whether a coefficient counts as negative. At a flat end, uses the sign of the first coefficient that is
  /// not zero.
  bool is_negative(size_t i) const {
    if (i == 0 && flat_begin)
      return *std::find_if(f.begin(), f.end() - 1, [](float x) { return x != 0; }) < 0;
    if (i == 5 && flat_end)
      return *std::find_if(f.rbegin(), f.rend() - 1, [](float x) { return x != 0; }) < 0;
    return f[i] < 0;
  }
  int sign_changes() const {
    int changes = 0;
    for (size_t i = 1; i < 6; ++i) changes += is_negative(i) != is_negative(i - 1) ? 1 : 0;
    return changes;
  }
  bool rises() const { return is_negative(0) && !is_negative(5); }
};

/// The single root between begin and end, below which c . c' is negative.
float solve(const PlaneCurve& curve, float begin, float end) {
  const auto evaluate = [](float point, const float(&d)[3], float u, float& first, float& second) {
    const float bend = d[1] - d[0], a = (d[2] - d[1]) - bend, b = 3 * bend, c = 3 * d[0];
    const float s = 1 - u, before = s * d[0] + u * d[1], behind = s * d[1] + u * d[2];
    first = 3 * (s * before + u * behind);
    second = 6 * (behind - before);
    return ((a * u + b) * u + c) * u + point;
  };
  float u = 0.5f * (begin + end);
  for (int i = 0; i < kMaxRootSteps && end - begin > kNearRoots; ++i) {
    float x1, x2, y1, y2;
    const float x = evaluate(curve.x[0], curve.dx, u, x1, x2), y = evaluate(curve.y[0], curve.dy, u, y1, y2);
    const float f = x * x1 + y * y1;
    (f < 0 ? begin : end) = u;
    float next = u - f / (x1 * x1 + y1 * y1 + x * x2 + y * y2);
    const bool halves = i >= kNewtonSteps && i % 2 == 0;
    if (halves || !(next >= begin && next <= end)) next = 0.5f * (begin + end);
    const float step = std::abs(next - u);
    u = next;
    if (step < kNearRoots && !halves) break;
  }
  return u;
}

}  // namespace

size_t nearest_parameters(const PlaneCurve& curve, float (&out)[3]) {
  FoldPart waiting[kMaxHalvings + 2];
  size_t depth = 0, count = 0;
  const auto is_flat = [&](size_t i) { return curve.dx[i] == 0 && curve.dy[i] == 0; };
  waiting[depth++] = {distance_derivative(curve), 0, 1, 0, is_flat(0), is_flat(2)};
  while (depth > 0 && count < 3) {
    const FoldPart part = waiting[--depth];
    const int changes = part.sign_changes();
    if (changes == 0 || (changes == 1 && !part.rises())) continue;
    if (changes == 1 || part.depth == kMaxHalvings) {
      if (part.rises()) out[count++] = solve(curve, part.begin, part.end);
      continue;
    }
    FoldPart left, right;
    part.halve(left, right);
    waiting[depth++] = right;
    waiting[depth++] = left;
  }
  return count;
}

}  // namespace pelage
