// SPDX-License-Identifier: Apache-2.0
// Part of fur_kernels.cpp: four plane curves and where they are nearest to the origin.

/// Bernstein weights of a cubic at u.
struct Weights {
  V w[4];
  HWY_INLINE explicit Weights(V u) {
    const V s = hn::Sub(all(1), u);
    const V ss = hn::Mul(s, s), uu = hn::Mul(u, u);
    w[0] = hn::Mul(ss, s);
    w[1] = hn::Mul(all(3), hn::Mul(ss, u));
    w[2] = hn::Mul(all(3), hn::Mul(s, uu));
    w[3] = hn::Mul(uu, u);
  }
  HWY_INLINE V operator()(const V (&p)[4]) const {
    return hn::Add(hn::Add(hn::Mul(w[0], p[0]), hn::Mul(w[1], p[1])),
                   hn::Add(hn::Mul(w[2], p[2]), hn::Mul(w[3], p[3])));
  }
};

/// One coordinate of a curve as a polynomial.
struct Cubic {
  V a, b, c, d;
  HWY_INLINE explicit Cubic(const V (&p)[4]) {
    c = hn::Mul(all(3), hn::Sub(p[1], p[0]));
    b = hn::Sub(hn::Mul(all(3), hn::Sub(p[2], p[1])), c);
    a = hn::Sub(hn::Sub(hn::Sub(p[3], p[0]), c), b);
    d = p[0];
  }
  HWY_INLINE V value(V u) const {
    return hn::Add(hn::Mul(hn::Add(hn::Mul(hn::Add(hn::Mul(a, u), b), u), c), u), d);
  }
  HWY_INLINE V first(V u) const {
    const V b2 = hn::Add(b, b);
    return hn::Add(hn::Mul(hn::Add(hn::Mul(hn::Mul(all(3), a), u), b2), u), c);
  }
  HWY_INLINE V second(V u) const {
    const V three = hn::Mul(all(3), hn::Mul(a, u));
    const V half = hn::Add(three, b);
    return hn::Add(half, half);
  }
};

/// Where the distance of curves to the origin may have minima: lanes with one, found here, and lanes with
/// perhaps several.
struct Minima {
  uint32_t single, folded;
  V f0, f5;

  HWY_INLINE Minima(const V (&x)[4], const V (&y)[4]) {
    V dx[3], dy[3];
    for (int i = 0; i < 3; ++i) dx[i] = hn::Sub(x[i + 1], x[i]), dy[i] = hn::Sub(y[i + 1], y[i]);
    const auto product = [&](int p, int d) HWY_ATTR { return dot(x[p], y[p], dx[d], dy[d]); };
    const V two = all(2), three = all(3), six = all(6);
    V f1 = hn::Add(hn::Mul(two, product(0, 1)), hn::Mul(three, product(1, 0)));
    const V f2 = hn::Add(hn::Add(product(0, 2), hn::Mul(six, product(1, 1))), hn::Mul(three, product(2, 0)));
    const V f3 = hn::Add(hn::Add(hn::Mul(three, product(1, 2)), hn::Mul(six, product(2, 1))), product(3, 0));
    V f4 = hn::Add(hn::Mul(three, product(2, 2)), hn::Mul(two, product(3, 1)));
    // Minus zero becomes zero: a minimum at the end is one, and one at the beginning belongs to the segment
    // before.
    const V zero = hn::Zero(kFloats);
    f0 = hn::Add(product(0, 0), zero);
    f5 = hn::Add(product(3, 2), zero);
    // Where points at an end coincide, the curve arrives there along the next difference that is not zero.
    const auto flat0 = hn::And(hn::Eq(dx[0], zero), hn::Eq(dy[0], zero));
    const auto flat1 = hn::And(hn::Eq(dx[1], zero), hn::Eq(dy[1], zero));
    const auto flat2 = hn::And(hn::Eq(dx[2], zero), hn::Eq(dy[2], zero));
    f1 = hn::IfThenElse(hn::And(flat0, flat1), f2, f1);
    f0 = hn::IfThenElse(flat0, f1, f0);
    f4 = hn::IfThenElse(hn::And(flat2, flat1), f3, f4);
    f5 = hn::IfThenElse(flat2, f4, f5);
    // Sign bits: where a coefficient below zero follows one that is not, and the other way round.
    const V falls = hn::Or(hn::Or(hn::Or(hn::AndNot(f0, f1), hn::AndNot(f1, f2)),
                                  hn::Or(hn::AndNot(f2, f3), hn::AndNot(f3, f4))),
                           hn::AndNot(f4, f5));
    const V rises = hn::Or(hn::Or(hn::Or(hn::AndNot(f1, f0), hn::AndNot(f2, f1)),
                                  hn::Or(hn::AndNot(f3, f2), hn::AndNot(f4, f3))),
                           hn::AndNot(f5, f4));
    const uint32_t falling = sign_bits(falls), rising = sign_bits(rises);
    single = rising & ~falling;
    folded = rising & falling;
  }
};

/// The root of c . c' in (0, 1] of the lanes `active`, where it has exactly one. Newton's steps within a
/// bracket; each lane stops by itself.
HWY_INLINE V solve(const Cubic& x, const Cubic& y, V f0, V f5, uint32_t active) {
  V u = hn::Div(f0, hn::Sub(f0, f5));
  V low = hn::Zero(kFloats), high = all(1);
  auto done = hn::FirstN(kFloats, 0);
  for (int i = 0; i < 12; ++i) {
    const V cx = x.value(u), cy = y.value(u), x1 = x.first(u), y1 = y.first(u);
    const V f = dot(cx, cy, x1, y1);
    const V slope = hn::Add(dot(x1, y1, x1, y1), dot(cx, cy, x.second(u), y.second(u)));
    const auto below = hn::Lt(f, hn::Zero(kFloats));
    low = hn::IfThenElse(below, u, low);
    high = hn::IfThenElse(below, high, u);
    const V newton = hn::Sub(u, hn::Div(f, slope));
    const auto inside = hn::And(hn::Ge(newton, low), hn::Le(newton, high));
    const V next = hn::IfThenElse(inside, newton, hn::Mul(all(0.5f), hn::Add(low, high)));
    const auto small = hn::Le(hn::Abs(hn::Sub(next, u)), all(0x1p-13f));
    u = hn::IfThenElse(done, u, next);
    done = hn::Or(done, small);
    if ((active & ~bits_of<float>(done)) == 0) break;
  }
  return u;
}
