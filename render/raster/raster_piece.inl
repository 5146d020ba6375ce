// SPDX-License-Identifier: Apache-2.0
// Part of raster_kernels.cpp: pieces of strands.

template <bool kLens, bool kMoving>
class PieceKernel {
 public:
  PieceKernel(const RasterTarget& target, const RasterPiece& piece, const KeySpan& keys)
      : target_(target),
        keys_(keys),
        p_(piece.at.p),
        d_(piece.at.d),
        q_(piece.at.q),
        c_(piece.at.c),
        p_motion_(piece.motion.p),
        d_motion_(piece.motion.d),
        q_motion_(piece.motion.q),
        c_motion_(piece.motion.c),
        r_(all(piece.r)),
        dr_(all(piece.dr)),
        low_(all(piece.low)),
        high_(all(piece.high)),
        first_u_(all(piece.segment_u)),
        du_(all(piece.segment_du)),
        near_(all(target.near)) {
    const float bulge = std::max(piece.at.bulge(), piece.after().bulge());
    const float reach = std::max(piece.r, piece.r + piece.dr) + 1.5f * bulge;
    reach2_ = all(reach * reach);
    const float bulge_z = std::max(piece.at.depth_bulge(), piece.after().depth_bulge());
    const V3f from = piece.at.p, to = piece.at.end();
    float nearest = std::min(from.z, to.z);
    if (kMoving) nearest = std::min({nearest, from.z + piece.motion.p.z, to.z + piece.motion.end().z});
    nearest_ = all(nearest - bulge_z - 1e-5f * std::abs(nearest));
  }

  /// Which of the lines that begin at `i` may meet the piece: lines beside the piece that do not end before
  /// it.
  HWY_INLINE M may_meet(size_t i, M inside) const {
    inside = hn::And(inside, hn::Ge(at(target_.lines.depth, i), nearest_));
    if (hn::AllFalse(kFloats, inside)) return inside;
    const Lines<kLens> lines(target_.lines, i);
    Vector p = p_, d = d_;
    if constexpr (kMoving) {
      const V f = key_fraction(target_.lines, i, keys_, inside);
      p = p.moved(p_motion_, f), d = d.moved(d_motion_, f);
    }
    const V px = lines.beside_x(p), py = lines.beside_y(p), ex = lines.seen_x(d), ey = lines.seen_y(d);
    const V ee = dot(ex, ey, ex, ey), beside = cross(ex, ey, px, py), along = dot(px, py, ex, ey);
    inside = hn::And(inside, hn::Le(hn::Mul(beside, beside), hn::Mul(reach2_, ee)));
    // Before the beginning or after the end.
    const V before = hn::Max(along, hn::Neg(hn::Add(along, ee)));
    const V outside = hn::Max(before, hn::Zero(kFloats));
    return hn::And(inside, hn::Le(hn::Mul(outside, outside), hn::Mul(reach2_, ee)));
  }
  /// Draws to the first `count` lines of these. Returns whether anything changed.
  HWY_INLINE bool draw(const uint32_t* numbers, size_t count) const {
    const Indices i = hn::LoadU(kIndices, reinterpret_cast<const int32_t*>(numbers));
    M inside = hn::FirstN(kFloats, count);
    const Lines<kLens> lines(target_.lines, i);
    Vector p = p_, d = d_, q = q_, c = c_;
    if constexpr (kMoving) {
      const V f = key_fraction(target_.lines, i, keys_, inside);
      p = p.moved(p_motion_, f), d = d.moved(d_motion_, f), q = q.moved(q_motion_, f),
      c = c.moved(c_motion_, f);
    }
    const V px = lines.beside_x(p), py = lines.beside_y(p), ex = lines.seen_x(d), ey = lines.seen_y(d);
    const V tiny = all(1e-30f), zero = hn::Zero(kFloats), one = all(1), half = all(0.5f);
    // The nearest point of the chord, and two steps of Newton's method along the curve.
    const V qx = lines.seen_x(q), qy = lines.seen_y(q), cx = lines.seen_x(c), cy = lines.seen_y(c);
    V u = hn::Div(hn::Neg(dot(px, py, ex, ey)), hn::Max(dot(ex, ey, ex, ey), tiny));
    for (int step = 0; step < 2; ++step) {
      u = hn::Min(hn::Max(u, all(-0.25f)), all(1.25f));
      const V s = hn::Sub(one, u), us = hn::Mul(u, s), w = hn::Sub(half, u), w2 = hn::Add(w, w);
      const V dc = hn::Sub(hn::Mul(w2, w), us);
      const V rx = hn::Add(hn::Add(px, hn::Mul(u, ex)), hn::Mul(us, hn::Add(qx, hn::Mul(w, cx))));
      const V ry = hn::Add(hn::Add(py, hn::Mul(u, ey)), hn::Mul(us, hn::Add(qy, hn::Mul(w, cy))));
      const V gx = hn::Add(ex, hn::Add(hn::Mul(w2, qx), hn::Mul(dc, cx)));
      const V gy = hn::Add(ey, hn::Add(hn::Mul(w2, qy), hn::Mul(dc, cy)));
      u = hn::Sub(u, hn::Div(dot(rx, ry, gx, gy), hn::Max(dot(gx, gy, gx, gy), tiny)));
    }
    inside = hn::And(inside, hn::And(hn::Ge(u, low_), hn::Le(u, high_)));
    const V v = hn::Min(hn::Max(u, zero), one), vs = hn::Mul(v, hn::Sub(one, v)), w = hn::Sub(half, v);
    const V x = hn::Add(hn::Add(px, hn::Mul(v, ex)), hn::Mul(vs, hn::Add(qx, hn::Mul(w, cx))));
    const V y = hn::Add(hn::Add(py, hn::Mul(v, ey)), hn::Mul(vs, hn::Add(qy, hn::Mul(w, cy))));
    const V z = hn::Add(hn::Add(p.z, hn::Mul(v, d.z)), hn::Mul(vs, hn::Add(q.z, hn::Mul(w, c.z))));
    const V radius = hn::Add(r_, hn::Mul(v, dr_));
    M hit = hn::And(inside, hn::Lt(dot(x, y, x, y), hn::Mul(radius, radius)));
    hit = hn::And(hit, hn::And(hn::Gt(z, near_), hn::Le(z, at(target_.lines.depth, i))));
    uint32_t lanes = bits_of(hit);
    if (lanes == 0) return false;
    float us[TileLines::kPadding], zs[TileLines::kPadding];
    hn::StoreU(hn::Add(first_u_, hn::Mul(v, du_)), kFloats, us);
    hn::StoreU(z, kFloats, zs);
    bool changed = false;
    for (; lanes != 0; lanes &= lanes - 1) {
      const auto lane = static_cast<size_t>(std::countr_zero(lanes));
      changed |= store_line(target_, numbers[lane], zs[lane], us[lane]);
    }
    return changed;
  }

 private:
  const RasterTarget& target_;
  const KeySpan& keys_;
  Vector p_, d_, q_, c_, p_motion_, d_motion_, q_motion_, c_motion_;
  V r_, dr_, low_, high_, first_u_, du_, near_, reach2_, nearest_;
};
