// SPDX-License-Identifier: Apache-2.0
#include "render/raster/flat_pieces.h"

#include <algorithm>
#include <cmath>
#include <limits>

namespace pelage {
namespace {

/// Pieces are wider than the segment by this fraction of its radius, because Newton's method is not exact.
constexpr float kTolerance = 0.005f;
/// Max bulge of a piece relative to its length: then two steps of Newton's method find its nearest point.
constexpr float kMaxBend = 0.35f;
/// Max distance, relative to the radius, of the nearest point beyond the end of a segment. Pieces have
/// slightly different tangents than their segment, so the pieces of two segments meet at a small angle.
constexpr float kBeyondEnd = 0.05f;

/// A vector as it is seen from the origin beside the point `at`.
V2f seen(const V3f& v, const V3f& at) {
  const float z = std::max(at.z, 1e-20f);
  return {v.x - v.z * (at.x / z), v.y - v.z * (at.y / z)};
}

size_t count_of(const TileSegment& s) {
  const V3f bend0 = s.p[2] - 2.0f * s.p[1] + s.p[0], bend1 = s.p[3] - 2.0f * s.p[2] + s.p[1];
  const V3f chord = s.p[3] - s.p[0], middle = 0.5f * (s.p[0] + s.p[3]);
  const float length = seen(chord, middle).length();
  const float bend = std::sqrt(std::max(seen(bend0, middle).length2(), seen(bend1, middle).length2()));
  // q of a piece is three times its second difference; the chord is as long as the segment's.
  const float for_bend = 3 * bend / (kMaxBend * std::max(length, 1e-30f));
  return static_cast<size_t>(std::clamp(std::ceil(for_bend), 1.0f, float{FlatPieces::kMaxPieces}));
}

V3f point(const std::array<V3f, 4>& p, float u) {
  const float s = 1 - u;
  return s * s * s * p[0] + 3 * s * s * u * p[1] + 3 * s * u * u * p[2] + u * u * u * p[3];
}
float radius(const std::array<float, 4>& r, float u) {
  const float s = 1 - u;
  return s * s * s * r[0] + 3 * s * s * u * r[1] + 3 * s * u * u * r[2] + u * u * u * r[3];
}

/// `size`: of the piece, as a fraction of the segment.
RasterPiece::Curve curve(const TileSegment& s, const V3f& begin, const V3f& end, float middle, float size) {
  const V3f third = s.p[3] - 3.0f * s.p[2] + 3.0f * s.p[1] - s.p[0];
  const V3f q = 4.0f * (point(s.p, middle) - 0.5f * (begin + end));
  return {begin, end - begin, q, size * size * size * third};
}

/// Error of the radius in the middle of a piece, where it is largest.
float radius_error(const TileSegment& s, float u0, float u1) {
  return std::abs(radius(s.r, 0.5f * (u0 + u1)) - 0.5f * (radius(s.r, u0) + radius(s.r, u1)));
}

/// Returns how far beyond the ends of a piece, as a fraction of its length, the parameter of its nearest
/// point may be computed. `centre`: of the piece. `r`: max radius.
float beyond_ends(const RasterPiece::Curve& curve, const V3f& centre, float r) {
  const float length = seen(curve.d, centre).length();
  if (seen(curve.q, centre).length() + seen(curve.c, centre).length() > 2 * kMaxBend * length)
    return std::numeric_limits<float>::infinity();
  return kBeyondEnd * r / std::max(length, 1e-30f) + 1e-5f;
}

}  // namespace

Four FlatPieces::max_error(const FourSegments& s) {
  const auto size = [](Four x) { return larger(x, -x); };
  const Four radius = larger(larger(s.r[0], s.r[1]), larger(s.r[2], s.r[3]));
  const Four radius_bend =
      larger(size(s.r[0] - four(2) * s.r[1] + s.r[2]), size(s.r[1] - four(2) * s.r[2] + s.r[3]));
  return four(1.01f * kTolerance) * radius + four(0.76f) * radius_bend;
}

FlatPieces::FlatPieces(const TileSegment& from, const TileSegment& to, float wider) {
  const bool moves = &from != &to;
  count_ = std::max(count_of(from), moves ? count_of(to) : 1);
  const auto n = static_cast<float>(count_);
  V3f begin = from.p[0], begin_to = to.p[0];
  for (size_t i = 0; i < count_; ++i) {
    const float u0 = static_cast<float>(i) / n, u1 = static_cast<float>(i + 1) / n, middle = 0.5f * (u0 + u1);
    const bool first = i == 0, last = i + 1 == count_;
    const V3f end = last ? from.p[3] : point(from.p, u1), end_to = last ? to.p[3] : point(to.p, u1);
    RasterPiece& piece = pieces_[i];
    piece.at = curve(from, begin, end, middle, u1 - u0);
    piece.moves = moves;
    float r0 = radius(from.r, u0), r1 = radius(from.r, u1), slack = radius_error(from, u0, u1);
    if (moves) {
      const RasterPiece::Curve after = curve(to, begin_to, end_to, middle, u1 - u0);
      piece.motion = {after.p - piece.at.p, after.d - piece.at.d, after.q - piece.at.q, after.c - piece.at.c};
      r0 = std::max(r0, radius(to.r, u0));
      r1 = std::max(r1, radius(to.r, u1));
      slack = std::max(slack, radius_error(to, u0, u1));
    }
    slack += kTolerance * std::max(r0, r1);
    piece.r = (r0 + slack) * (1 + wider);
    piece.dr = (r1 + slack) * (1 + wider) - piece.r;
    float beyond = beyond_ends(piece.at, 0.5f * (begin + end), std::max(r0, r1));
    if (moves) {
      beyond = std::max(beyond, beyond_ends(piece.after(), 0.5f * (begin_to + end_to), std::max(r0, r1)));
    }
    piece.low = first ? -beyond : -std::numeric_limits<float>::infinity();
    piece.high = last ? 1 + beyond : std::numeric_limits<float>::infinity();
    piece.segment_u = u0;
    piece.segment_du = u1 - u0;
    begin = end;
    begin_to = end_to;
  }
}

}  // namespace pelage
