// SPDX-License-Identifier: Apache-2.0
#include "rib/syntax/rib_curve_layout.h"

#include <algorithm>
#include <cmath>

#include <fmt/format.h>

#include "base/nearest_name.h"

namespace pelage {
namespace {

V3f point_of(std::span<const float> p, size_t index) {
  index %= p.size() / 3;
  return {p[3 * index], p[3 * index + 1], p[3 * index + 2]};
}

V3f weighted(const std::array<float, 4>& weights, std::span<const float> p, size_t first) {
  V3f sum(0);
  for (size_t i = 0; i < 4; ++i) sum += weights[i] * point_of(p, first + i);
  return sum;
}

/// Appends the control points of the B-spline that interpolates `x` (one value per joint, x[i] at i) and has
/// the derivatives `d0` and `d1` at its ends.
void append_interpolation(const std::vector<V3f>& x, const V3f& d0, const V3f& d1, std::vector<float>& out) {
  const size_t n = x.size();
  std::vector<V3f> p(n + 2);
  // p[i + 1] belongs to x[i]. Row i: p[i] + 4 p[i + 1] + p[i + 2] = 6 x[i]; the first and the last point
  // follow from the derivatives. Thomas' algorithm in double precision is not needed: the matrix is
  // diagonally dominant.
  std::vector<float> upper(n);
  float pivot = 4;
  p[1] = (6.0f * x[0] + 2.0f * d0) / pivot;
  for (size_t i = 1; i < n; ++i) {
    const bool last = i + 1 == n;
    const float lower = last ? 2.0f : 1.0f;
    upper[i - 1] = (i == 1 ? 2.0f : 1.0f) / pivot;
    pivot = 4 - lower * upper[i - 1];
    const V3f right = 6.0f * x[i] - (last ? 2.0f * d1 : V3f(0));
    p[i + 1] = (right - lower * p[i]) / pivot;
  }
  for (size_t i = n - 1; i-- > 0;) p[i + 1] -= upper[i] * p[i + 2];
  p[0] = p[2] - 2.0f * d0;
  p[n + 1] = p[n - 1] + 2.0f * d1;
  for (const V3f& point : p) out.insert(out.end(), {point.x, point.y, point.z});
}

}  // namespace

size_t RibCurveLayout::values(RibClass frequency) const {
  switch (frequency) {
    case RibClass::kConstant:
      return 1;
    case RibClass::kUniform:
      return points.size();
    case RibClass::kVertex:
      return total_points;
    case RibClass::kVarying:
    case RibClass::kFaceVarying:
      break;
  }
  return total_joints;
}

void RibCurveLayout::fit_stray_joints(size_t values) {
  const size_t own = total_joints - unusable * (cubic ? stray_joints : 0);
  if (!cubic || unusable == 0 || values < own || (values - own) % unusable != 0) return;
  stray_joints = static_cast<uint32_t>((values - own) / unusable);
  total_joints = values;
}

RibCurveLayout read_curve_layout(const RibStatement& request, const RibBasis& basis) {
  const std::vector<RibOperand>& a = request.arguments;
  const auto text = [&](size_t i) { return i < a.size() && !a[i].is_number() && !a[i].is_array; };
  if (!text(0) || a.size() < 3 || a[1].kind == RibOperand::Kind::kStrings || !text(2))
    request.fail("expected a type, an array of integers, a wrap mode and parameters");
  RibCurveLayout layout;
  layout.basis = basis;
  const std::string &type = a[0].strings[0], &wrap = a[2].strings[0];
  if (type != "linear" && type != "cubic")
    request.fail(a[0], "unknown type " + quote(type) + "; expected \"linear\" or \"cubic\"");
  if (wrap != "periodic" && wrap != "nonperiodic" && wrap != "pinned")
    request.fail(
        a[2], "unknown wrap mode " + quote(wrap) + "; expected \"periodic\", \"nonperiodic\" or \"pinned\"");
  layout.cubic = type == "cubic";
  layout.periodic = wrap == "periodic";
  // Curves of other bases reach their ends anyway.
  using Kind = RibBasis::Kind;
  layout.pinned = wrap == "pinned" && layout.cubic && basis.step == 1 &&
                  (basis.kind == Kind::kBSpline || basis.kind == Kind::kCatmullRom);
  if (a[1].kind == RibOperand::Kind::kFloats && a[1].size() > 0)
    request.fail(a[1], "expected integers, got " + a[1].describe());
  for (const int64_t count : a[1].integers) {
    if (count < 0 || static_cast<uint64_t>(count) + layout.total_points > kMaxRibCount)
      request.fail(a[1], "a curve has " + std::to_string(count) + " points");
    const auto points = static_cast<uint32_t>(count);
    const bool by_points = !layout.cubic || layout.pinned;
    const uint32_t segments = !by_points        ? basis.segments(points, layout.periodic)
                              : layout.periodic ? (points < 2 ? 0 : points)
                                                : std::max(points, 1u) - 1;
    layout.unusable += segments == 0;
    layout.points.push_back(points);
    layout.segments.push_back(segments);
    layout.total_points += points;
    layout.total_joints += layout.joints(layout.points.size() - 1);
  }
  return layout;
}

std::vector<uint32_t> strand_starts(const RibCurveLayout& layout, size_t curve, std::span<const float> p) {
  const auto step = static_cast<size_t>(layout.basis.step);
  std::vector<uint32_t> starts{0};
  const auto begin = layout.basis.weights(0), end = layout.basis.weights(1);
  for (uint32_t s = 1; s < layout.segments[curve]; ++s) {
    const V3f from = weighted(end, p, (s - 1) * step), to = weighted(begin, p, s * step);
    const V3f before = weighted(begin, p, (s - 1) * step);
    if (!((to - from).length() <= 1e-4f * ((from - before).length() + (to - before).length())))
      starts.push_back(s);
  }
  return starts;
}

void resample_curve(const RibCurveLayout& layout, size_t curve, std::span<const float> p,
                    std::span<const uint32_t> first, std::vector<float>& out) {
  const auto step = static_cast<size_t>(layout.basis.step);
  const float h = 1.0f / kRibSubdivision;
  for (size_t piece = 0; piece < first.size(); ++piece) {
    const uint32_t end = piece + 1 < first.size() ? first[piece + 1] : layout.segments[curve];
    std::vector<V3f> x;
    for (uint32_t s = first[piece]; s < end; ++s) {
      for (uint32_t k = 0; k < kRibSubdivision; ++k)
        x.push_back(weighted(layout.basis.weights(h * static_cast<float>(k)), p, s * step));
    }
    x.push_back(weighted(layout.basis.weights(1), p, (end - 1) * step));
    const V3f d0 = h * weighted(layout.basis.derivative_weights(0), p, first[piece] * step);
    const V3f d1 = h * weighted(layout.basis.derivative_weights(1), p, (end - 1) * step);
    append_interpolation(x, d0, d1, out);
  }
}

}  // namespace pelage
