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
        p_motion_(piece.motion.p),
        d_motion_(piece.motion.d),
        q_motion_(piece.motion.q),
        r_(all(piece.r)),
        dr_(all(piece.dr)),
        low_(all(piece.low)),
        high_(all(piece.high)),
        first_u_(all(piece.segment_u)),
        du_(all(piece.segment_du)),
        near_(all(target.near)) {
    const float bulge = std::max(piece.at.bulge(), (piece.at.q + piece.motion.q).length() * 0.25f);
    const float reach = std::max(piece.r, piece.r + piece.dr) + 1.5f * bulge;
    reach2_ = all(reach * reach);
    const float bulge_z = 0.25f * (std::abs(piece.at.q.z) + std::abs(piece.motion.q.z));
    const V3f from = piece.at.p, to = piece.at.end();
    float nearest = std::min(from.z, to.z);
    if (kMoving) nearest = std::min({nearest, from.z + piece.motion.p.z, to.z + piece.motion.end().z});
    nearest_ = all(nearest - bulge_z - 1e-5f * std::abs(nearest));
  }

  /// Draws to the lines `inside` of those that begin at `i`. Returns whether anything changed.
  HWY_INLINE bool draw(size_t i, M inside) const {
    inside = hn::And(inside, hn::Ge(at(target_.lines.depth, i), nearest_));
    if (hn::AllFalse(kFloats, inside)) return false;
    const Lines<kLens> lines(target_.lines, i);
    Vector p = p_, d = d_, q = q_;
    if constexpr (kMoving) {
      const V f = key_fraction(target_.lines, i, keys_, inside);
      p = p.moved(p_motion_, f), d = d.moved(d_motion_, f), q = q.moved(q_motion_, f);
    }
    const V px = lines.beside_x(p), py = lines.beside_y(p), ex = lines.seen_x(d), ey = lines.seen_y(d);
    const V tiny = all(1e-30f), zero = hn::Zero(kFloats), one = all(1);
    const V ee = dot(ex, ey, ex, ey), beside = cross(ex, ey, px, py);
    inside = hn::And(inside, hn::Le(hn::Mul(beside, beside), hn::Mul(reach2_, ee)));
    if (hn::AllFalse(kFloats, inside)) return false;

    // The nearest point of the chord, and one step of Newton's method along the parabola.
    const V qx = lines.seen_x(q), qy = lines.seen_y(q);
    const V along = hn::Div(hn::Neg(dot(px, py, ex, ey)), hn::Max(ee, tiny));
    const V u = hn::Min(hn::Max(along, all(-0.25f)), all(1.25f)), s = hn::Sub(one, u), bend = hn::Sub(s, u);
    const V rx = hn::Add(px, hn::Mul(u, hn::Add(ex, hn::Mul(s, qx))));
    const V ry = hn::Add(py, hn::Mul(u, hn::Add(ey, hn::Mul(s, qy))));
    const V gx = hn::Add(ex, hn::Mul(bend, qx)), gy = hn::Add(ey, hn::Mul(bend, qy));
    const V step = hn::Div(hn::Neg(dot(rx, ry, gx, gy)), hn::Max(dot(gx, gy, gx, gy), tiny));
    const V nearest = hn::Add(u, step);
    inside = hn::And(inside, hn::And(hn::Ge(nearest, low_), hn::Le(nearest, high_)));
    const V v = hn::Min(hn::Max(nearest, zero), one), dv = hn::Sub(v, u), dv2 = hn::Mul(dv, dv);
    const V x = hn::Sub(hn::Add(rx, hn::Mul(dv, gx)), hn::Mul(dv2, qx));
    const V y = hn::Sub(hn::Add(ry, hn::Mul(dv, gy)), hn::Mul(dv2, qy));
    const V radius = hn::Add(r_, hn::Mul(v, dr_));
    const V z = hn::Add(p.z, hn::Mul(v, hn::Add(d.z, hn::Mul(hn::Sub(one, v), q.z))));
    M hit = hn::And(inside, hn::Lt(dot(x, y, x, y), hn::Mul(radius, radius)));
    hit = hn::And(hit, hn::And(hn::Gt(z, near_), hn::Le(z, at(target_.lines.depth, i))));
    if (hn::AllFalse(kFloats, hit)) return false;
    return store(target_, i, hit, z, hn::Add(first_u_, hn::Mul(v, du_)));
  }

 private:
  const RasterTarget& target_;
  const KeySpan& keys_;
  Vector p_, d_, q_, p_motion_, d_motion_, q_motion_;
  V r_, dr_, low_, high_, first_u_, du_, near_, reach2_, nearest_;
};
