// SPDX-License-Identifier: Apache-2.0
// Part of fur_kernels.cpp: vectors of four numbers, or as many as the instruction set supports up to a
// block's 16.

using Floats = hn::Full128<float>;
using Ints = hn::Full128<int32_t>;
using V = hn::Vec<Floats>;
constexpr Floats kFloats;
using Words = hn::Full128<uint32_t>;
constexpr Ints kInts;
constexpr Words kWords;
using Many = hn::CappedTag<float, 16>;
constexpr Many kMany;
using Doubles = hn::CappedTag<double, 4>;
constexpr Doubles kDoubles;

PELAGE_FUR_INLINE V all(float x) { return hn::Set(kFloats, x); }

template <class T>
PELAGE_FUR_INLINE uint32_t bits_of(hn::Mask<hn::Full128<T>> mask) {
  uint8_t bytes[8] = {};
  hn::StoreMaskBits(hn::Full128<T>(), mask, bytes);
  return bytes[0];
}

PELAGE_FUR_INLINE uint32_t sign_bits(V v) {
  return bits_of<int32_t>(hn::Lt(hn::BitCast(kInts, v), hn::Zero(kInts)));
}

PELAGE_FUR_INLINE V bytes_at(const std::byte* place) {
  const hn::Simd<uint8_t, 4, 0> bytes;
  return hn::ConvertTo(kFloats,
                       hn::PromoteTo(kInts, hn::LoadU(bytes, reinterpret_cast<const uint8_t*>(place))));
}

/// Numbers of a block from index `first` on, with those of its first points set to zero, or all others.
template <class D>
PELAGE_FUR_INLINE hn::Vec<D> of_first_point(D d, size_t first, hn::Vec<D> v) {
  if (first > 0) return hn::Zero(d);
  if constexpr (hn::MaxLanes(D()) == 4) return v;
  return hn::IfThenElseZero(hn::FirstN(d, 4), v);
}
template <class D>
PELAGE_FUR_INLINE hn::Vec<D> without_first_point(D d, size_t first, hn::Vec<D> v) {
  if (first > 0) return v;
  if constexpr (hn::MaxLanes(D()) == 4) return hn::Zero(d);
  return hn::IfThenZeroElse(hn::FirstN(d, 4), v);
}

PELAGE_FUR_INLINE V cross(V ax, V ay, V bx, V by) { return hn::Sub(hn::Mul(ax, by), hn::Mul(ay, bx)); }
PELAGE_FUR_INLINE V dot(V ax, V ay, V bx, V by) { return hn::Add(hn::Mul(ax, bx), hn::Mul(ay, by)); }
