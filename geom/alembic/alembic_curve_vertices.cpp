// SPDX-License-Identifier: Apache-2.0
#include "geom/alembic/alembic_curve_vertices.h"

#include <algorithm>

namespace pelage {
namespace {

/// x, y, z and the radius: a sum of two points of strands.
struct WeightedPoint {
  float v[4];
};
WeightedPoint weighted(const float* a, float s, const float* b, float t) {
  WeightedPoint sum;
  for (int i = 0; i < 4; ++i) sum.v[i] = s * a[i] + t * b[i];
  return sum;
}

AlembicBasis alembic_basis(CurveBasis basis) {
  if (basis == CurveBasis::kLinear) return AlembicBasis::kNone;
  if (basis == CurveBasis::kCatmullRom) return AlembicBasis::kCatmullRom;
  return basis == CurveBasis::kBezier ? AlembicBasis::kBezier : AlembicBasis::kBSpline;
}

}  // namespace

AlembicCurveVertices::AlembicCurveVertices(const Strands& strands, AlembicHost host) : strands_(strands) {
  const CurveBasis basis = strands.basis();
  const bool unreal = host == AlembicHost::kUnreal, pinned = basis == CurveBasis::kPinnedBSpline;
  type_ = unreal || basis == CurveBasis::kLinear ? AlembicCurveType::kLinear : AlembicCurveType::kCubic;
  basis_ = unreal ? AlembicBasis::kNone : alembic_basis(basis);
  phantom_ends_ = !unreal && (pinned || basis == CurveBasis::kCatmullRom);
  knots_ = unreal && (pinned || basis == CurveBasis::kBSpline);
  inner_ = unreal && basis == CurveBasis::kBSpline;
  swap_ = unreal;
  for (size_t s = 0; s < strands.strand_count(); ++s) count_ += count(s);
}

size_t AlembicCurveVertices::count(size_t strand) const {
  const size_t n = strands_.strand_points(strand);
  if (inner_) return std::max<size_t>(n, 2) - 2;
  return phantom_ends_ && n > 0 ? n + 2 : n;
}

AlembicCurveVertex AlembicCurveVertices::point(const float* p, size_t index) const {
  return {swap_ ? V3f(p[0], p[2], p[1]) : V3f(p[0], p[1], p[2]), 2 * p[3], index};
}

AlembicCurveVertex AlembicCurveVertices::vertex(size_t strand, size_t i) const {
  const size_t n = strands_.strand_points(strand), first = strands_.first_point(strand);
  const float* p = strands_.points().data() + 4 * first;
  if (phantom_ends_ && (i == 0 || i == n + 1)) {
    const size_t end = i == 0 ? 0 : n - 1, next = i == 0 ? std::min<size_t>(1, n - 1) : (n > 1 ? n - 2 : 0);
    AlembicCurveVertex phantom = point(weighted(p + 4 * end, 2, p + 4 * next, -1).v, first + end);
    phantom.width = std::max(phantom.width, 0.0f);
    return phantom;
  }
  const size_t at = phantom_ends_ ? i - 1 : inner_ ? i + 1 : i;
  if (!knots_ || at == 0 || at + 1 == n) return point(p + 4 * at, first + at);
  const WeightedPoint sides = weighted(p + 4 * (at - 1), 1 / 6.0f, p + 4 * (at + 1), 1 / 6.0f);
  return point(weighted(sides.v, 1, p + 4 * at, 4 / 6.0f).v, first + at);
}

}  // namespace pelage
