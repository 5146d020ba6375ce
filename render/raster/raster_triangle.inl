// SPDX-License-Identifier: Apache-2.0
// Part of raster_kernels.cpp: triangles.

template <bool kLens, bool kMoving>
class TriangleKernel {
 public:
  TriangleKernel(const RasterTarget& target, const RasterTriangle& triangle, const KeySpan& keys)
      : target_(target),
        keys_(keys),
        corners_{Vector(triangle.corners[0]), Vector(triangle.corners[1]), Vector(triangle.corners[2])},
        motion_{Vector(triangle.motion[0]), Vector(triangle.motion[1]), Vector(triangle.motion[2])},
        near_(all(target.near)) {}

  /// Draws to the lines `inside` of those that begin at `i`. Returns whether anything changed.
  HWY_INLINE bool draw(size_t i, M inside) const {
    const Lines<kLens> lines(target_.lines, i);
    Vector a = corners_[0], b = corners_[1], c = corners_[2];
    if constexpr (kMoving) {
      const V f = key_fraction(target_.lines, i, keys_, inside);
      a = a.moved(motion_[0], f), b = b.moved(motion_[1], f), c = c.moved(motion_[2], f);
    }
    const V ax = lines.beside_x(a), ay = lines.beside_y(a), bx = lines.beside_x(b), by = lines.beside_y(b),
            cx = lines.beside_x(c), cy = lines.beside_y(c);
    // Twice the areas that the line and two corners span. The same edge of two triangles has opposite areas.
    const V wa = cross(bx, by, cx, cy), wb = cross(cx, cy, ax, ay), wc = cross(ax, ay, bx, by);
    const V zero = hn::Zero(kFloats);
    const V min = hn::Min(wa, hn::Min(wb, wc)), max = hn::Max(wa, hn::Max(wb, wc));
    M hit = hn::And(inside, hn::Or(hn::Ge(min, zero), hn::Le(max, zero)));
    if (hn::AllFalse(kFloats, hit)) return false;
    const V sum = hn::Add(hn::Add(wa, wb), wc);
    const V z = hn::Div(hn::Add(hn::Add(hn::Mul(wa, a.z), hn::Mul(wb, b.z)), hn::Mul(wc, c.z)), sum);
    // False for a triangle that is seen from the side, whose areas are all zero.
    hit = hn::And(hit, hn::And(hn::Gt(z, near_), hn::Le(z, at(target_.lines.depth, i))));
    if (hn::AllFalse(kFloats, hit)) return false;
    return store(target_, i, hit, z);
  }

 private:
  const RasterTarget& target_;
  const KeySpan& keys_;
  Vector corners_[3], motion_[3];
  V near_;
};
