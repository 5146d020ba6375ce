// SPDX-License-Identifier: Apache-2.0
// Part of fur_kernels.cpp: four planar curves and their nearest points to the origin.

/// Four curves in ray space: points, and differences of consecutive points. The differences are not computed
/// from the rounded points but are accurate relative to their own size: for a curve along the ray they are
/// much smaller than the points.
struct FlatCurves {
  V x[4], y[4], dx[3], dy[3];

  /// Computes the points from the first one and the differences.
  PELAGE_FUR_INLINE void add_points() {
    for (int i = 0; i < 3; ++i) x[i + 1] = hn::Add(x[i], dx[i]), y[i + 1] = hn::Add(y[i], dy[i]);
  }
};

/// Bernstein weights of a cubic at u.
struct Weights {
  V w[4];
  PELAGE_FUR_INLINE explicit Weights(V u) {
    const V s = hn::Sub(all(1), u);
    const V ss = hn::Mul(s, s), uu = hn::Mul(u, u);
    w[0] = hn::Mul(ss, s);
    w[1] = hn::Mul(all(3), hn::Mul(ss, u));
    w[2] = hn::Mul(all(3), hn::Mul(s, uu));
    w[3] = hn::Mul(uu, u);
  }
  PELAGE_FUR_INLINE V operator()(const V (&p)[4]) const {
    return hn::Add(hn::Add(hn::Mul(w[0], p[0]), hn::Mul(w[1], p[1])),
                   hn::Add(hn::Mul(w[2], p[2]), hn::Mul(w[3], p[3])));
  }
};

/// One coordinate of a curve as a polynomial.
struct Cubic {
  V a, b, c, d;
  /// From the first point and the differences that follow.
  PELAGE_FUR_INLINE Cubic(V first, const V (&differences)[3]) {
    const V bend = hn::Sub(differences[1], differences[0]);
    a = hn::Sub(hn::Sub(differences[2], differences[1]), bend);
    b = hn::Mul(all(3), bend);
    c = hn::Mul(all(3), differences[0]);
    d = first;
  }
  PELAGE_FUR_INLINE V value(V u) const {
    return hn::Add(hn::Mul(hn::Add(hn::Mul(hn::Add(hn::Mul(a, u), b), u), c), u), d);
  }
};

/// A third of the first derivative of one coordinate, and a sixth of the second. Computed from a polynomial,
/// the first derivative would be lost in rounding where a curve nearly stands still.
struct Derivatives {
  V first, second;
  PELAGE_FUR_INLINE Derivatives(const V (&differences)[3], V u) {
    const V s = hn::Sub(all(1), u);
    const V before = hn::Add(hn::Mul(s, differences[0]), hn::Mul(u, differences[1]));
    const V behind = hn::Add(hn::Mul(s, differences[1]), hn::Mul(u, differences[2]));
    first = hn::Add(hn::Mul(s, before), hn::Mul(u, behind));
    second = hn::Sub(behind, before);
  }
};

/// Where the distance of curves to the origin may have minima: lanes with exactly one, and lanes with
/// possibly several.
struct Minima {
  uint32_t single, folded;
  V f0, f5;

  /// The last points are given as the first points of the following segments. Where strands are smooth their
  /// differences agree too: a minimum there belongs to one of two neighbours, never to none.
  PELAGE_FUR_INLINE Minima(const FlatCurves& at, V end_x, V end_y) {
    const V(&dx)[3] = at.dx, (&dy)[3] = at.dy;
    const auto product = [&](int p, int d) HWY_ATTR { return dot(at.x[p], at.y[p], dx[d], dy[d]); };
    const V two = all(2), three = all(3), six = all(6);
    V f1 = hn::Add(hn::Mul(two, product(0, 1)), hn::Mul(three, product(1, 0)));
    const V f2 = hn::Add(hn::Add(product(0, 2), hn::Mul(six, product(1, 1))), hn::Mul(three, product(2, 0)));
    const V f3 = hn::Add(hn::Add(hn::Mul(three, product(1, 2)), hn::Mul(six, product(2, 1))), product(3, 0));
    V f4 = hn::Add(hn::Mul(three, product(2, 2)), hn::Mul(two, product(3, 1)));
    // Minus zero becomes zero: a minimum at the end counts, one at the beginning belongs to the previous
    // segment.
    const V zero = hn::Zero(kFloats);
    f0 = hn::Add(product(0, 0), zero);
    f5 = hn::Add(dot(end_x, end_y, dx[2], dy[2]), zero);
    // Where points at an end coincide, the direction of the curve there is that of the next non-zero
    // difference.
    const auto flat0 = hn::And(hn::Eq(dx[0], zero), hn::Eq(dy[0], zero));
    const auto flat1 = hn::And(hn::Eq(dx[1], zero), hn::Eq(dy[1], zero));
    const auto flat2 = hn::And(hn::Eq(dx[2], zero), hn::Eq(dy[2], zero));
    f1 = hn::IfThenElse(hn::And(flat0, flat1), f2, f1);
    f0 = hn::IfThenElse(flat0, f1, f0);
    f4 = hn::IfThenElse(hn::And(flat2, flat1), f3, f4);
    f5 = hn::IfThenElse(flat2, f4, f5);
    // Sign bits: where a negative coefficient follows a non-negative one, and vice versa.
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

constexpr float kClose = 0x1p-4f;  // steps of the grid; a width has 192 or more
constexpr float kShort = 0x1p-13f;
// One block in ten thousand takes more than six steps. A curve that nearly stops near the ray has an almost
// fivefold root: Newton's steps then cover only a fifth of the remaining distance, and every other step is a
// bisection.
constexpr int kNewtonSteps = 8, kMaxSteps = kNewtonSteps + 2 * 26;

/// The root of c . c' in (0, 1] of the lanes `active`, which must have exactly one. Newton's method within a
/// bracket; each lane stops separately, with a step of at most kClose along the curve in ray space and kShort
/// in the parameter.
PELAGE_FUR_INLINE V solve(const FlatCurves& at, const Cubic& x, const Cubic& y, V f0, V f5, uint32_t active) {
  V u = hn::Div(f0, hn::Sub(f0, f5));
  V low = hn::Zero(kFloats), high = all(1);
  // The last points computed from the first ones are rounded differently from those of f5, which may place
  // the root beyond them.
  auto done = hn::Lt(dot(at.x[3], at.y[3], at.dx[2], at.dy[2]), low);
  u = hn::IfThenElse(done, high, u);
  for (int i = 0; i < kMaxSteps; ++i) {
    const V cx = x.value(u), cy = y.value(u);
    const Derivatives dx(at.dx, u), dy(at.dy, u);
    const V f = dot(cx, cy, dx.first, dy.first);  // a third of c . c'
    const V speed2 = dot(dx.first, dy.first, dx.first, dy.first);
    const V bend = dot(cx, cy, dx.second, dy.second);
    const V slope = hn::Add(hn::Mul(all(3), speed2), hn::Add(bend, bend));
    const auto below = hn::Lt(f, hn::Zero(kFloats));
    low = hn::IfThenElse(below, u, low);
    high = hn::IfThenElse(below, high, u);
    const V newton = hn::Sub(u, hn::Div(f, slope)), middle = hn::Mul(all(0.5f), hn::Add(low, high));
    const auto inside = hn::And(hn::Ge(newton, low), hn::Le(newton, high));
    const bool halves = i >= kNewtonSteps && i % 2 == 0;
    const V next = halves ? middle : hn::IfThenElse(inside, newton, middle);
    const V step = hn::Sub(next, u);
    constexpr float kClose2 = kClose * kClose / 9;
    const V most2 = hn::Max(speed2, all(kClose2 / (kShort * kShort)));
    const auto small = hn::Le(hn::Mul(hn::Mul(step, step), most2), all(kClose2));
    u = hn::IfThenElse(done, u, next);
    if (halves) continue;  // the size of that step does not bound the distance to the root
    done = hn::Or(done, small);
    if ((active & ~bits_of<float>(done)) == 0) break;
  }
  return u;
}
