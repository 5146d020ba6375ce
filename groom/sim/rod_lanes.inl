// SPDX-License-Identifier: Apache-2.0
// Part of rod_kernel.cpp: one number, vector or quaternion of each of several rods.

using D = hn::CappedTag<double, RodPack::kLanes>;
using V = hn::Vec<D>;
using M = hn::Mask<D>;
constexpr D kDoubles;
// Distance of numbers in doubles: in a pack, and in the memory of the kernel.
constexpr size_t kStride = RodPack::kLanes;
constexpr size_t kOwn = hn::MaxLanes(D());

HWY_INLINE V all(double x) { return hn::Set(kDoubles, x); }
HWY_INLINE V zero() { return hn::Zero(kDoubles); }
HWY_INLINE V number(const double* at) { return hn::LoadU(kDoubles, at); }
HWY_INLINE void store(V v, double* at) { hn::StoreU(v, kDoubles, at); }
HWY_INLINE V choose(M mask, V yes, V no) { return hn::IfThenElse(mask, yes, no); }

struct V3 {
  V x, y, z;
};
HWY_INLINE V3 operator+(const V3& a, const V3& b) { return {a.x + b.x, a.y + b.y, a.z + b.z}; }
HWY_INLINE V3 operator-(const V3& a, const V3& b) { return {a.x - b.x, a.y - b.y, a.z - b.z}; }
HWY_INLINE V3 operator*(const V3& a, V s) { return {a.x * s, a.y * s, a.z * s}; }
HWY_INLINE V dot(const V3& a, const V3& b) { return a.x * b.x + a.y * b.y + a.z * b.z; }
HWY_INLINE V3 cross(const V3& a, const V3& b) {
  return {a.y * b.z - a.z * b.y, a.z * b.x - a.x * b.z, a.x * b.y - a.y * b.x};
}
HWY_INLINE V3 minus(const V3& a) { return {hn::Neg(a.x), hn::Neg(a.y), hn::Neg(a.z)}; }
HWY_INLINE V3 choose(M mask, const V3& yes, const V3& no) {
  return {choose(mask, yes.x, no.x), choose(mask, yes.y, no.y), choose(mask, yes.z, no.z)};
}
HWY_INLINE V3 no_vector() { return {zero(), zero(), zero()}; }
/// Vectors of a pack, or of the kernel's own memory, at an index counted in numbers.
template <size_t kStep>
HWY_INLINE V3 vector(const double* at, size_t i) {
  return {number(at + i * kStep), number(at + (i + 1) * kStep), number(at + (i + 2) * kStep)};
}
template <size_t kStep>
HWY_INLINE void store_vector(const V3& v, double* at, size_t i) {
  store(v.x, at + i * kStep);
  store(v.y, at + (i + 1) * kStep);
  store(v.z, at + (i + 2) * kStep);
}

struct Q {
  V3 v;
  V r;
};
HWY_INLINE Q operator*(const Q& a, const Q& b) {
  return {b.v * a.r + a.v * b.r + cross(a.v, b.v), a.r * b.r - dot(a.v, b.v)};
}
HWY_INLINE Q conjugate(const Q& q) { return {minus(q.v), q.r}; }
HWY_INLINE Q normalized(const Q& q) {
  const V scale = all(1) / hn::Sqrt(dot(q.v, q.v) + q.r * q.r);
  return {q.v * scale, q.r * scale};
}
HWY_INLINE V3 turned(const Q& q, const V3& v) {
  const V3 c = cross(q.v, v), t = c + c;
  return v + t * q.r + cross(q.v, t);
}
HWY_INLINE Q quaternion(const double* at, size_t i) {
  return {vector<kStride>(at, i), number(at + (i + 3) * kStride)};
}
HWY_INLINE void store_quaternion(const Q& q, double* at, size_t i) {
  store_vector<kStride>(q.v, at, i);
  store(q.r, at + (i + 3) * kStride);
}
HWY_INLINE V3 third_axis(const Q& q) {
  const V two = all(2);
  return {two * (q.v.x * q.v.z + q.r * q.v.y), two * (q.v.y * q.v.z - q.r * q.v.x),
          all(1) - two * (q.v.x * q.v.x + q.v.y * q.v.y)};
}
/// As smallest_turn() of rod.h.
HWY_INLINE Q smallest_turn(const V3& from, const V3& to) {
  const V cosine = dot(from, to);
  const M opposite = cosine < all(-1 + 1e-12);
  Q turn{cross(from, to), all(1) + cosine};
  if (HWY_UNLIKELY(!hn::AllFalse(kDoubles, opposite))) {
    const M first = hn::Abs(from.x) < all(0.6);
    const V3 axis{choose(first, all(1), zero()), choose(first, zero(), all(1)), zero()};
    turn.v = choose(opposite, cross(from, axis), turn.v);
    turn.r = choose(opposite, zero(), turn.r);
  }
  return normalized(turn);
}
/// The Darboux vector between two frames, as Rod::darboux().
HWY_INLINE V3 darboux(const Q& q0, const Q& q1) {
  const V3 v = q1.v * q0.r - q0.v * q1.r - cross(q0.v, q1.v);
  const M reverse = q0.r * q1.r + dot(q0.v, q1.v) < zero();
  return v * choose(reverse, all(-2), all(2));
}
