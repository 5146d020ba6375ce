// SPDX-License-Identifier: Apache-2.0
// The test of fur_segments.inl with one ray per lane instead of one segment per lane: the same operations in
// the same order, so that each lane gets the same bits. Compiled once per instruction set.
#include "render/accel/highway_targets.h"

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "render/accel/fur/fur_segment_rays.cpp"
#if defined(__SANITIZE_ADDRESS__) || defined(__SANITIZE_THREAD__)
#define PELAGE_FUR_INLINE HWY_NOINLINE
#else
#define PELAGE_FUR_INLINE HWY_INLINE
#endif
#include <algorithm>
#include <bit>
#include <cmath>
#include <cstdint>
#include <utility>

#include <hwy/foreach_target.h>
#include <hwy/highway.h>

#include "render/accel/fur/fur_ray_batch.h"
#include "render/accel/fur/fur_segment_rays.h"

HWY_BEFORE_NAMESPACE();
namespace pelage {
namespace HWY_NAMESPACE {
namespace {

namespace hn = hwy::HWY_NAMESPACE;

using Floats = hn::CappedTag<float, FurSegmentRays::kMax>;
using Ints = hn::Rebind<int32_t, Floats>;
using V = hn::Vec<Floats>;
constexpr Floats kFloats;
constexpr Ints kInts;

PELAGE_FUR_INLINE V all(float x) { return hn::Set(kFloats, x); }
PELAGE_FUR_INLINE V cross(V ax, V ay, V bx, V by) { return hn::Sub(hn::Mul(ax, by), hn::Mul(ay, bx)); }
PELAGE_FUR_INLINE V dot(V ax, V ay, V bx, V by) { return hn::Add(hn::Mul(ax, bx), hn::Mul(ay, by)); }
template <class T>
PELAGE_FUR_INLINE uint32_t bits_of(hn::Mask<hn::Rebind<T, Floats>> mask) {
  uint8_t bytes[8] = {};
  hn::StoreMaskBits(hn::Rebind<T, Floats>(), mask, bytes);
  return bytes[0] | uint32_t{bytes[1]} << 8;
}
PELAGE_FUR_INLINE uint32_t sign_bits(V v) {
  return bits_of<int32_t>(hn::Lt(hn::BitCast(kInts, v), hn::Zero(kInts)));
}

#include "render/accel/fur/fur_curves.inl"
//
#include "render/accel/fur/fur_ray_lanes.inl"

/// Returns the lanes that this cannot decide.
uint32_t closest(const FurRayBatch& rays, const SnappedSegment& segment, uint32_t number, FurHit* hits) {
  RayLanes lanes;
  lanes.prepare(rays, segment);
  uint32_t undecided = 0;
  for (size_t first = 0; first < rays.count; first += hn::MaxLanes(kFloats)) {
    const size_t count = std::min(rays.count - first, hn::MaxLanes(kFloats));
    const auto valid = (1u << count) - 1;
    undecided |= test_rays(rays, lanes, segment, number, first, valid, hits) << first;
  }
  return undecided;
}

}  // namespace
}  // namespace HWY_NAMESPACE
}  // namespace pelage
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace pelage {
namespace {
HWY_EXPORT(closest);
}  // namespace

uint32_t FurSegmentRays::closest(const FurTreeView& tree, const SnappedSegment& segment, uint32_t number,
                                 std::span<const Ray* const> rays, FurHit* hits) {
  const FurRayBatch batch(tree, rays);
  uint32_t undecided = HWY_DYNAMIC_DISPATCH(closest)(batch, segment, number, hits) | batch.others;
  for (size_t i = 0; i < rays.size(); ++i) hits[i].distance *= tree.step;
  return undecided & ((1u << rays.size()) - 1);
}

}  // namespace pelage
#endif
