// SPDX-License-Identifier: Apache-2.0
// Compiled once per instruction set. Lanes never meet, products and sums are never fused and nothing is
// approximated, so that every set gives the same bits.
#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "render/accel/fur/fur_kernels.cpp"
#define HWY_DISABLED_TARGETS HWY_SSSE3
// The plain fallback is four lanes too. What g++ before 12.3 gets wrong there (high halves of 16-bit
// products) is not used here.
#define HWY_BROKEN_EMU128 0
#include <algorithm>
#include <bit>
#include <cmath>
#include <cstdint>
#include <utility>

#include <hwy/cache_control.h>
#include <hwy/foreach_target.h>
#include <hwy/highway.h>

#include "render/accel/fur/fur_leaf.h"
#include "render/accel/fur/fur_node.h"
#include "render/accel/fur/fur_query.h"
#include "render/accel/fur/fur_ray.h"
#include "render/accel/fur/fur_tree.h"

HWY_BEFORE_NAMESPACE();
namespace pelage {
namespace HWY_NAMESPACE {
namespace {

namespace hn = hwy::HWY_NAMESPACE;

using Floats = hn::Full128<float>;
using Ints = hn::Full128<int32_t>;
using V = hn::Vec<Floats>;
constexpr Floats kFloats;
using Words = hn::Full128<uint32_t>;
constexpr Ints kInts;
constexpr Words kWords;

HWY_INLINE V all(float x) { return hn::Set(kFloats, x); }

template <class T>
HWY_INLINE uint32_t bits_of(hn::Mask<hn::Full128<T>> mask) {
  uint8_t bytes[8] = {};
  hn::StoreMaskBits(hn::Full128<T>(), mask, bytes);
  return bytes[0];
}

HWY_INLINE uint32_t sign_bits(V v) {
  return bits_of<int32_t>(hn::Lt(hn::BitCast(kInts, v), hn::Zero(kInts)));
}

HWY_INLINE V bytes_at(const std::byte* place) {
  const hn::Simd<uint8_t, 4, 0> bytes;
  return hn::ConvertTo(kFloats,
                       hn::PromoteTo(kInts, hn::LoadU(bytes, reinterpret_cast<const uint8_t*>(place))));
}

/// The four curves of a block: Bezier points by axis, radii.
template <bool kWide, bool kMoving>
class Block {
 public:
  HWY_INLINE Block(const std::byte* block, const FurRay& ray)
      : key_(block + sizeof(FurBlockHeader) + static_cast<size_t>(ray.key) * kSizes.key()),
        before_(all(1 - ray.fraction)),
        after_(all(ray.fraction)) {
    const auto whole = hn::Load(kInts, reinterpret_cast<const int32_t*>(block));
    const V origin = hn::ConvertTo(kFloats, whole);
    origin_[0] = hn::Broadcast<0>(origin);
    origin_[1] = hn::Broadcast<1>(origin);
    origin_[2] = hn::Broadcast<2>(origin);
  }

  HWY_INLINE void load_axis(uint32_t axis, V (&p)[4]) const {
    for (size_t i = 0; i < 4; ++i) {
      const std::byte* place = key_ + axis * kSizes.axis + i * (kSizes.axis / 4);
      p[i] = coordinate(place, axis);
      if constexpr (kMoving) p[i] = mix(p[i], coordinate(place + kSizes.key(), axis));
    }
  }
  HWY_INLINE void load_radii(V (&r)[4]) const {
    for (size_t i = 0; i < 4; ++i) {
      const std::byte* place = key_ + 3 * kSizes.axis + i * (kSizes.radii / 4);
      r[i] = radius(place);
      if constexpr (kMoving) r[i] = mix(r[i], radius(place + kSizes.key()));
    }
  }
  HWY_INLINE V most_radius() const {
    if constexpr (kWide || kMoving) {
      V r[4];
      load_radii(r);
      return hn::Max(hn::Max(r[0], r[1]), hn::Max(r[2], r[3]));
    } else {
      const std::byte* place = key_ + 3 * kSizes.axis;
      const V root = hn::Max(hn::Max(bytes_at(place), bytes_at(place + 4)),
                             hn::Max(bytes_at(place + 8), bytes_at(place + 12)));
      return square_of(root);
    }
  }

 private:
  static constexpr FurBlockSizes kSizes = kWide ? kWideBlock : kNarrowBlock;

  static HWY_INLINE V square_of(V root) { return hn::Mul(hn::Mul(root, root), all(1.0f / 256)); }
  HWY_INLINE V mix(V a, V b) const { return hn::Add(hn::Mul(a, before_), hn::Mul(b, after_)); }
  HWY_INLINE V coordinate(const std::byte* place, uint32_t axis) const {
    if constexpr (kWide) {
      return hn::Load(kFloats, reinterpret_cast<const float*>(place));
    } else {
      const hn::Simd<uint16_t, 4, 0> words;
      const auto difference =
          hn::PromoteTo(kInts, hn::LoadU(words, reinterpret_cast<const uint16_t*>(place)));
      return hn::Add(hn::ConvertTo(kFloats, difference), origin_[axis]);
    }
  }
  HWY_INLINE V radius(const std::byte* place) const {
    if constexpr (kWide) {
      return hn::Load(kFloats, reinterpret_cast<const float*>(place));
    } else {
      return square_of(bytes_at(place));
    }
  }

  const std::byte* key_;
  V origin_[3];
  V before_, after_;
};

HWY_INLINE V cross(V ax, V ay, V bx, V by) { return hn::Sub(hn::Mul(ax, by), hn::Mul(ay, bx)); }
HWY_INLINE V dot(V ax, V ay, V bx, V by) { return hn::Add(hn::Mul(ax, bx), hn::Mul(ay, by)); }

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

/// The curves of one block against the ray. True when nothing more need be known of this ray.
template <bool kWide, bool kMoving, class Query>
HWY_INLINE bool test_block(const std::byte* block, const FurRay& ray, Query& query) {
  const Block<kWide, kMoving> curves(block, ray);
  V pi[4], pj[4], pk[4], x[4], y[4];
  curves.load_axis(ray.axis[0], pi);
  curves.load_axis(ray.axis[1], pj);
  curves.load_axis(ray.axis[2], pk);
  const V dk = all(ray.along_k), di = all(ray.along_i), dj = all(ray.along_j);
  const V origin_x = all(ray.origin_x), origin_y = all(ray.origin_y);
  const V scale_x = all(ray.scale_x), scale_y = all(ray.scale_y), shear_y = all(ray.shear_y);
  for (int i = 0; i < 4; ++i) {
    const V wide_x = hn::Sub(hn::Sub(hn::Mul(dk, pi[i]), hn::Mul(di, pk[i])), origin_x);
    const V wide_y = hn::Sub(hn::Sub(hn::Mul(dk, pj[i]), hn::Mul(dj, pk[i])), origin_y);
    x[i] = hn::Mul(wide_x, scale_x);
    y[i] = hn::Sub(hn::Mul(wide_y, scale_y), hn::Mul(wide_x, shear_y));
  }

  // The curve lies within a strip along its chord: a cubic strays from the chord by at most 3/4 of what its
  // inner points do.
  const V ex = hn::Sub(x[3], x[0]), ey = hn::Sub(y[3], y[0]);
  const V c0 = cross(ex, ey, x[0], y[0]);
  const V a = hn::Sub(cross(ex, ey, x[1], y[1]), c0), b = hn::Sub(cross(ex, ey, x[2], y[2]), c0);
  const V zero = hn::Zero(kFloats), most = all(0.75f);
  const V high = hn::Add(c0, hn::Mul(most, hn::Max(zero, hn::Max(a, b))));
  const V low = hn::Add(c0, hn::Mul(most, hn::Min(zero, hn::Min(a, b))));
  const V reach = hn::Mul(curves.most_radius(), hn::Sqrt(dot(ex, ey, ex, ey)));
  const uint32_t near_strip = bits_of<float>(hn::And(hn::Le(low, reach), hn::Ge(hn::Add(high, reach), zero)));
  if (near_strip == 0) return false;

  const Minima minima(x, y);
  const uint32_t single = minima.single & near_strip, folded = minima.folded & near_strip;
  if ((single | folded) == 0) return false;

  V r[4], z[4];
  curves.load_radii(r);
  const auto load_depths = [&]() HWY_ATTR {
    const V di_z = all(ray.depth[ray.axis[0]]), dj_z = all(ray.depth[ray.axis[1]]),
            dk_z = all(ray.depth[ray.axis[2]]), origin = all(ray.origin_depth);
    for (int i = 0; i < 4; ++i) {
      z[i] =
          hn::Sub(hn::Add(hn::Add(hn::Mul(di_z, pi[i]), hn::Mul(dj_z, pj[i])), hn::Mul(dk_z, pk[i])), origin);
    }
  };
  const uint32_t* numbers = reinterpret_cast<const FurBlockHeader*>(block)->number;
  const auto lane_of = [&](uint32_t lane) HWY_ATTR {
    alignas(16) float values[4];
    FurLane result;
    const auto copy = [&](const V(&from)[4], float(&to)[4]) HWY_ATTR {
      for (int i = 0; i < 4; ++i) {
        hn::Store(from[i], kFloats, values);
        to[i] = values[lane];
      }
    };
    copy(x, result.x);
    copy(y, result.y);
    copy(z, result.z);
    copy(r, result.r);
    return result;
  };

  if (single != 0) {
    const Cubic curve_x(x), curve_y(y);
    const V u = solve(curve_x, curve_y, minima.f0, minima.f5, single);
    const V cx = curve_x.value(u), cy = curve_y.value(u);
    const V distance2 = dot(cx, cy, cx, cy);
    const Weights weights(u);
    const V radius = weights(r);
    uint32_t hits = bits_of<float>(hn::Lt(distance2, hn::Mul(radius, radius))) & single;
    if (hits != 0) {
      load_depths();
      const V side = cross(curve_x.first(u), curve_y.first(u), cx, cy);
      const V h = hn::CopySign(hn::Div(hn::Sqrt(distance2), radius), side);
      alignas(16) float us[4], ts[4], hs[4];
      hn::Store(weights(z), kFloats, ts);
      hn::Store(u, kFloats, us);
      hn::Store(h, kFloats, hs);
      for (; hits != 0; hits &= hits - 1) {
        const auto lane = static_cast<uint32_t>(std::countr_zero(hits));
        const uint32_t number = numbers[lane];
        if (!query.wants(ts[lane], number)) continue;
        if (is_on_start(ray, number) && is_start(ray, number, lane_of(lane), us[lane], ts[lane])) continue;
        if (query.take({ts[lane], number, us[lane], hs[lane]})) return true;
      }
    }
  }
  if (HWY_LIKELY(folded == 0)) return false;
  load_depths();
  for (uint32_t lanes = folded; lanes != 0; lanes &= lanes - 1) {
    const auto lane = static_cast<uint32_t>(std::countr_zero(lanes));
    if (test_folded(lane_of(lane), numbers[lane], ray, query)) return true;
  }
  return false;
}

/// Wide blocks are rare.
template <bool kMoving, class Query>
HWY_NOINLINE bool test_wide_block(const std::byte* block, const FurRay& ray, Query& query) {
  return test_block<true, kMoving>(block, ray, query);
}

template <bool kMoving, class Query>
HWY_INLINE bool test_leaf(const FurTreeView& tree, FurReference leaf, const FurRay& ray, Query& query) {
  const std::byte* block = tree.leaves + leaf.leaf_offset();
  const size_t size = (leaf.is_wide() ? kWideBlock : kNarrowBlock).block(tree.motion_keys);
  if constexpr (Query::kCounts) query.tests.segments += 4 * leaf.blocks();
  for (uint32_t i = 0; i < leaf.blocks(); ++i, block += size) {
    if (HWY_UNLIKELY(leaf.is_wide())) {
      if (test_wide_block<kMoving>(block, ray, query)) return true;
    } else if (test_block<false, kMoving>(block, ray, query)) {
      return true;
    }
  }
  return false;
}

/// A ray against the four boxes of a node of floats.
template <bool kMoving>
class FloatSlabs {
 public:
  HWY_INLINE FloatSlabs(const FurTreeView& tree, const FurRay& ray)
      : references_(FurFloatNode::references(tree.motion_keys)),
        key_(static_cast<size_t>(ray.key) * FurFloatNode::kKey),
        before_(all(1 - ray.fraction)),
        after_(all(ray.fraction)) {
    for (size_t axis = 0; axis < 3; ++axis) {
      inverse_[axis] = all(ray.inverse[axis]);
      near_origin_[axis] = all(ray.near_origin[axis]);
      far_origin_[axis] = all(ray.far_origin[axis]);
      near_side_[axis] = axis * FurFloatNode::kAxis + ray.near_side[axis] * FurFloatNode::kSide;
    }
  }
  HWY_INLINE const uint32_t* references(const std::byte* node) const {
    return reinterpret_cast<const uint32_t*>(node + references_);
  }
  HWY_INLINE hn::Mask<Floats> meet(const std::byte* node, V& enter, V leave) const {
    for (size_t axis = 0; axis < 3; ++axis) {
      const V near_side = side(node + near_side_[axis]),
              far_side = side(node + (near_side_[axis] ^ FurFloatNode::kSide));
      enter = hn::Max(hn::Mul(hn::Sub(near_side, near_origin_[axis]), inverse_[axis]), enter);
      leave = hn::Min(hn::Mul(hn::Sub(far_side, far_origin_[axis]), inverse_[axis]), leave);
    }
    return hn::Le(enter, leave);
  }

 private:
  HWY_INLINE V side(const std::byte* place) const {
    const V a = hn::Load(kFloats, reinterpret_cast<const float*>(place + key_));
    if constexpr (!kMoving) return a;
    const V b = hn::Load(kFloats, reinterpret_cast<const float*>(place + key_ + FurFloatNode::kKey));
    return hn::Add(hn::Mul(a, before_), hn::Mul(b, after_));
  }
  size_t references_, key_;
  V before_, after_, inverse_[3], near_origin_[3], far_origin_[3];
  size_t near_side_[3];
};

/// The same of a quantised node.
template <bool kMoving>
class QuantisedSlabs {
 public:
  HWY_INLINE QuantisedSlabs(const FurTreeView&, const FurRay& ray)
      : key_(FurQuantisedNode::kPlanes + static_cast<size_t>(ray.key) * FurQuantisedNode::kKey),
        before_(all(1 - ray.fraction)),
        after_(all(ray.fraction)),
        inverse_(hn::Load(kFloats, ray.inverse)),
        near_origin_(hn::Load(kFloats, ray.near_origin)),
        far_origin_(hn::Load(kFloats, ray.far_origin)) {
    for (size_t axis = 0; axis < 3; ++axis) {
      near_side_[axis] = axis * FurQuantisedNode::kAxis + ray.near_side[axis] * FurQuantisedNode::kSide;
    }
  }
  HWY_INLINE const uint32_t* references(const std::byte* node) const {
    return reinterpret_cast<const uint32_t*>(node + FurQuantisedNode::kReferences);
  }
  HWY_INLINE hn::Mask<Floats> meet(const std::byte* node, V& enter, V leave) const {
    const V origin = hn::LoadU(kFloats, reinterpret_cast<const float*>(node + FurQuantisedNode::kOrigin));
    const V scale = hn::LoadU(kFloats, reinterpret_cast<const float*>(node + FurQuantisedNode::kScale));
    const V step = hn::Mul(scale, inverse_);
    const V first = hn::Mul(hn::Sub(origin, near_origin_), inverse_);
    const V last = hn::Mul(hn::Sub(origin, far_origin_), inverse_);
    node += key_;
    meet_axis<0>(node, step, first, last, enter, leave);
    meet_axis<1>(node, step, first, last, enter, leave);
    meet_axis<2>(node, step, first, last, enter, leave);
    return hn::Le(enter, leave);
  }

 private:
  template <int kAxis>
  HWY_INLINE void meet_axis(const std::byte* planes, V step, V first, V last, V& enter, V& leave) const {
    const V steps = hn::Broadcast<kAxis>(step);
    const V near_side = side(planes + near_side_[kAxis]);
    const V far_side = side(planes + (near_side_[kAxis] ^ FurQuantisedNode::kSide));
    enter = hn::Max(hn::Add(hn::Mul(near_side, steps), hn::Broadcast<kAxis>(first)), enter);
    leave = hn::Min(hn::Add(hn::Mul(far_side, steps), hn::Broadcast<kAxis>(last)), leave);
  }
  HWY_INLINE V side(const std::byte* place) const {
    const V a = bytes_at(place);
    if constexpr (!kMoving) return a;
    return hn::Add(hn::Mul(a, before_), hn::Mul(bytes_at(place + FurQuantisedNode::kKey), after_));
  }
  size_t key_;
  V before_, after_, inverse_, near_origin_, far_origin_;
  size_t near_side_[3];
};

constexpr size_t kDeferred = 6;  // leaves that may wait: enough to hide the way to memory
// Nodes that may wait. A walk in depth keeps three per level, and trees have less than 70 levels; beyond
// kMixed the walk is one in depth.
constexpr size_t kStack = 512, kMixed = 256;

/// Children that were met and wait for their visit: references and where the ray enters them.
template <size_t kRoom>
struct Waiting {
  uint32_t references[kRoom];
  float enters[kRoom];
  size_t count = 0;

  /// Adds the lanes `chosen` in their order, without a branch.
  HWY_INLINE void add(hn::Vec<Words> children, V enter, hn::Mask<Floats> chosen) {
    const size_t n = hn::CompressStore(hn::BitCast(kFloats, children), chosen, kFloats,
                                       reinterpret_cast<float*>(references + count));
    hn::CompressStore(enter, chosen, kFloats, enters + count);
    count += n;
  }
  /// Brings what was added since `first` in order: the nearest comes last.
  HWY_INLINE void order(size_t first) {
    for (size_t i = first + 1; i < count; ++i) {
      const uint32_t reference = references[i];
      const float enter = enters[i];
      size_t place = i;
      for (; place > first && enters[place - 1] < enter; --place) {
        enters[place] = enters[place - 1];
        references[place] = references[place - 1];
      }
      enters[place] = enter;
      references[place] = reference;
    }
  }
};

HWY_INLINE void fetch_lines(const std::byte* place, size_t bytes) {
  for (size_t i = 0; i < bytes; i += 64) hwy::Prefetch(place + i);
}

/// Through the tree, more or less front to back. What will be visited later is fetched ahead: leaves wait
/// until a few of them have come together, and where the order does not matter every node waits for one
/// visit.
template <class Slabs, bool kMoving, class Query>
HWY_INLINE void walk(const FurTreeView& tree, const FurRay& ray, Query& query) {
  const Slabs slabs(tree, ray);
  Waiting<kStack> nodes;
  Waiting<16> leaves{};
  nodes.references[0] = 0;
  nodes.enters[0] = ray.near;
  nodes.count = 1;
  while (true) {
    while (nodes.count > 0 && leaves.count < kDeferred) {
      --nodes.count;
      uint32_t next = nodes.references[nodes.count];
      const float next_enter = nodes.enters[nodes.count];
      if (!Query::kOrdered && nodes.count > 0 && nodes.count < kMixed) {
        std::swap(next, nodes.references[nodes.count - 1]);
      }
      if (Query::kOrdered && next_enter > query.far()) continue;
      const std::byte* node = tree.nodes + FurReference::from_bits(next).node_offset();
      if constexpr (Query::kCounts) query.tests.boxes += 4;
      V enter = all(ray.near);
      const auto met = slabs.meet(node, enter, all(query.far()));
      const auto references = hn::LoadU(kWords, slabs.references(node));
      const auto is_leaf =
          hn::MaskFromVec(hn::BitCast(kFloats, hn::BroadcastSignBit(hn::BitCast(kInts, references))));
      const auto is_node = hn::RebindMask(kFloats, hn::Gt(hn::BitCast(kInts, references), hn::Zero(kInts)));
      const size_t first_node = nodes.count, first_leaf = leaves.count;
      nodes.add(references, enter, hn::And(met, is_node));
      leaves.add(references, enter, hn::And(met, is_leaf));
      if constexpr (Query::kOrdered) {
        if (nodes.count - first_node > 1) nodes.order(first_node);
      }
      for (size_t i = first_node; i < nodes.count; ++i) {
        fetch_lines(tree.nodes + FurReference::from_bits(nodes.references[i]).node_offset(), 64);
      }
      for (size_t i = first_leaf; i < leaves.count; ++i) {
        fetch_lines(tree.leaves + FurReference::from_bits(leaves.references[i]).leaf_offset(), 144);
      }
    }
    if (leaves.count == 0) return;
    for (size_t i = 0; i < leaves.count; ++i) {
      if (leaves.enters[i] > query.far()) continue;
      if (test_leaf<kMoving>(tree, FurReference::from_bits(leaves.references[i]), ray, query)) return;
    }
    leaves.count = 0;
  }
}

template <class Query>
HWY_INLINE void trace(const FurTreeView& tree, const FurRay& ray, Query& query) {
  if (tree.motion_keys > 1) {
    if (tree.layout == FurNodeLayout::kFloat) {
      walk<FloatSlabs<true>, true>(tree, ray, query);
    } else {
      walk<QuantisedSlabs<true>, true>(tree, ray, query);
    }
  } else if (tree.layout == FurNodeLayout::kFloat) {
    walk<FloatSlabs<false>, false>(tree, ray, query);
  } else {
    walk<QuantisedSlabs<false>, false>(tree, ray, query);
  }
}

template <class Query>
Query answer(const FurTreeView& tree, const FurRay& ray, FurFilter* filter) {
  Query query(ray, filter, tree.step);
  trace(tree, ray, query);
  return query;
}

FurHit closest(const FurTreeView& tree, const FurRay& ray, FurFilter* filter, FurTests* tests) {
  if (HWY_LIKELY(!tests)) return answer<NearestFur>(tree, ray, filter).hit;
  const auto counted = answer<Counting<NearestFur>>(tree, ray, filter);
  *tests += counted.tests;
  return counted.hit;
}

bool occluded(const FurTreeView& tree, const FurRay& ray, FurFilter* filter, FurTests* tests) {
  if (HWY_LIKELY(!tests)) return answer<AnyFur>(tree, ray, filter).hit;
  const auto counted = answer<Counting<AnyFur>>(tree, ray, filter);
  *tests += counted.tests;
  return counted.hit;
}

}  // namespace
}  // namespace HWY_NAMESPACE
}  // namespace pelage
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace pelage {
namespace {
HWY_EXPORT(closest);
HWY_EXPORT(occluded);
}  // namespace

FurHit closest_fur(const FurTreeView& tree, const FurRay& ray, FurFilter* filter, FurTests* tests) {
  FurHit hit = HWY_DYNAMIC_DISPATCH(closest)(tree, ray, filter, tests);
  if (!hit) return {};
  hit.distance *= tree.step;
  return hit;
}

bool fur_occludes(const FurTreeView& tree, const FurRay& ray, FurFilter* filter, FurTests* tests) {
  return HWY_DYNAMIC_DISPATCH(occluded)(tree, ray, filter, tests);
}

}  // namespace pelage
#endif
