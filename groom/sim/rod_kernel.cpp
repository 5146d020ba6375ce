// SPDX-License-Identifier: Apache-2.0
// Steps of several rods side by side (groom/sim/rod_pack.h): the same equations as in rod_step.cpp. Compiled
// once per instruction set. Lanes are independent, and products and sums are never fused, so that every
// instruction set gives the same bits.

// The instruction sets that most processors have, and no others: each takes seconds to compile.
#if defined(__SANITIZE_ADDRESS__) || defined(__SANITIZE_THREAD__)
#define HWY_DISABLED_TARGETS (HWY_SSSE3 | HWY_SSE4 | HWY_AVX3 | HWY_AVX3_DL)
#else
#define HWY_DISABLED_TARGETS (HWY_SSSE3 | HWY_SSE4 | HWY_AVX3_DL)
#endif
#define HWY_BROKEN_EMU128 0
#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "groom/sim/rod_kernel.cpp"
#include <hwy/foreach_target.h>
#include <hwy/highway.h>

#include "groom/sim/rod_numbers.h"
#include "groom/sim/rod_pack.h"

HWY_BEFORE_NAMESPACE();
namespace pelage {
namespace HWY_NAMESPACE {
namespace {

namespace hn = hwy::HWY_NAMESPACE;
using namespace rod_numbers;

#include "groom/sim/rod_lanes.inl"
//
#include "groom/sim/rod_front.inl"
//
#include "groom/sim/rod_terms.inl"

void start_step(const RodTerms& t) {
  const RodPackView& p = t.pack;
  const V h = t.h;
  const size_t n = p.segments;
  const Q from = quaternion(p.root, 3), to = quaternion(p.target, 3);
  const V3 old_place = vector<kStride>(p.root, 0), place = vector<kStride>(p.target, 0);
  const Q turn = to * conjugate(from);
  Q before = from;
  for (size_t i = 0; i < n; ++i) {
    const Q frame = quaternion(p.frames, 4 * i);
    store_vector<kOwn>(darboux(before, frame), t.start_darboux, 3 * i);
    before = frame;
    store_quaternion(normalized(turn * frame), p.frames, 4 * i);
  }
  const V farthest = all(2) * number(p.length);
  for (size_t i = 0; i <= n; ++i) {
    const V3 x = vector<kStride>(p.positions, 3 * i);
    const V3 expected = x + vector<kStride>(p.velocities, 3 * i) * h + t.gravity * (h * h);
    const V3 carried = place + turned(turn, x - old_place);
    V3 lag = expected - carried;
    const V distance = hn::Sqrt(dot(lag, lag));
    const M far = distance > farthest;
    lag = choose(far, lag * (farthest / distance), lag);
    store_vector<kOwn>(x, t.start, 3 * i);
    store_vector<kOwn>(choose(far, carried + lag, expected), t.expected, 3 * i);
    store_vector<kStride>(carried, p.positions, 3 * i);
  }
}

/// One Newton iteration for the active lanes. Returns the lanes that need another one.
HWY_INLINE M apply(const RodTerms& t, M active, V& failed) {
  const RodPackView& p = t.pack;
  const size_t n = p.segments;
  V most = zero(), finite = zero();
  V3 last = no_vector();
  for (size_t i = 0; i < n; ++i) {
    const V3 moved = vector<kOwn>(t.solution, 4 * i + 4), change = moved - last;
    const V scale = number(t.inverse_edge + i * kOwn);
    const V angle2 = dot(change, change) * scale * scale;
    finite = finite + angle2 * zero() + number(t.solution + (4 * i + 3) * kOwn) * zero();
    most = hn::Max(most, angle2);
    last = moved;
  }
  failed = choose(finite == zero(), failed, all(1));
  const V part = choose(most > all(1), all(1) / hn::Sqrt(most), all(1));
  V3 behind = vector<kStride>(p.positions, 0);
  for (size_t i = 0; i < n; ++i) {
    const V3 step = vector<kOwn>(t.solution, 4 * i + 4) * part;
    const V3 old = vector<kStride>(p.positions, 3 * i + 3);
    const V3 x = choose(active, old + step, old);
    store_vector<kStride>(x, p.positions, 3 * i + 3);
    const V3 edge = x - behind;
    behind = x;
    const V length2 = dot(edge, edge);
    failed = choose(length2 > zero(), failed, all(1));
    const V3 along = edge * (all(1) / hn::Sqrt(length2));
    const Q frame = quaternion(p.frames, 4 * i);
    const V half =
        hn::Min(hn::Max(number(t.solution + (4 * i + 3) * kOwn) * part * all(0.5), all(-kMaxHalfTwist)),
                all(kMaxHalfTwist));
    const Q twist{along * half, all(1)};
    const Q next = normalized(twist * smallest_turn(third_axis(frame), along) * frame);
    store_quaternion({choose(active, next.v, frame.v), choose(active, next.r, frame.r)}, p.frames, 4 * i);
  }
  return hn::And(active, hn::And(most >= all(kConverged * kConverged), failed == zero()));
}

void step_lanes(const RodPackView& pack, const RodPack::Step& step) {
  const RodTerms terms(pack, step);
  start_step(terms);
  for (size_t k = 0; k < 7; ++k) store(number(pack.target + k * kStride), terms.root + k * kOwn);
  V failed = number(pack.failed);
  M active = zero() == zero();
  for (int k = 0; k < step.iterations; ++k) {
    terms.solve(failed);
    active = apply(terms, active, failed);
    if (hn::AllFalse(kDoubles, active)) break;
  }
  const V rate = all(1) / terms.h;
  for (size_t i = 0; i <= pack.segments; ++i) {
    const V3 moved = vector<kStride>(pack.positions, 3 * i) - vector<kOwn>(terms.start, 3 * i);
    store_vector<kStride>(moved * rate, pack.velocities, 3 * i);
  }
  for (size_t k = 0; k < 7; ++k) store(number(pack.target + k * kStride), pack.root + k * kStride);
  store(failed, pack.failed);
}

void step_rods(RodPack& pack, const RodPack::Step& step) {
  for (size_t first = 0; first < RodPack::kLanes; first += hn::Lanes(kDoubles))
    step_lanes(RodPackView(pack, first), step);
}

}  // namespace
}  // namespace HWY_NAMESPACE
}  // namespace pelage
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace pelage {
namespace {
HWY_EXPORT(step_rods);
}  // namespace

void RodPack::step(const Step& step) { HWY_DYNAMIC_DISPATCH(step_rods)(*this, step); }

}  // namespace pelage
#endif
