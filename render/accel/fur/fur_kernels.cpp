// SPDX-License-Identifier: Apache-2.0
// Compiled once per instruction set. Lanes are independent, products and sums are never fused, and no
// approximations are used, so that every instruction set gives the same bits.
#include "render/accel/highway_targets.h"

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "render/accel/fur/fur_kernels.cpp"
// Under sanitizers, functions are not inlined: many copies of all of them would take minutes to compile.
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

#include "render/accel/fur/fur_lanes.inl"
//
#include "render/accel/fur/fur_curves.inl"
//
#include "render/accel/fur/fur_block.inl"
//
#include "render/accel/fur/fur_ray_space.inl"
//
#include "render/accel/fur/fur_segments.inl"
//
#include "render/accel/fur/fur_slabs.inl"
//
#include "render/accel/fur/fur_walk.inl"

template <class Query>
PELAGE_FUR_INLINE void trace(const FurTreeView& tree, const FurRay& ray, Query& query) {
  if (tree.motion_keys > 1) {
    walk<Motion::kKeys>(tree, ray, query);
  } else {
    walk<Motion::kNone>(tree, ray, query);
  }
}

template <class Query>
Query answer(const FurTreeView& tree, const FurRay& ray, FurFilter* filter) {
  Query query(ray, filter, tree.step);
  trace(tree, ray, query);
  return query;
}

FurHit closest(const FurTreeView& tree, const FurRay& ray, FurFilter* filter) {
  return answer<NearestFur>(tree, ray, filter).hit;
}

FurHit closest_at(const FurTreeView& tree, const FurRay& ray, const FurSegmentPlace& at, FurFilter* filter) {
  NearestFur query(ray, filter, tree.step, at.number);
  if (!at.wide) {
    test_block<false, Motion::kAny>(at.block, ray, tree.motion_keys, query);
  } else if (tree.motion_keys > 1) {
    test_wide_block<Motion::kKeys>(at.block, ray, tree.motion_keys, query);
  } else {
    test_wide_block<Motion::kNone>(at.block, ray, tree.motion_keys, query);
  }
  return query.hit;
}

bool occluded(const FurTreeView& tree, const FurRay& ray, FurFilter* filter) {
  return answer<AnyFur>(tree, ray, filter).hit;
}

}  // namespace
}  // namespace HWY_NAMESPACE
}  // namespace pelage
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace pelage {
namespace {
HWY_EXPORT(closest);
HWY_EXPORT(closest_at);
HWY_EXPORT(occluded);
}  // namespace

FurHit closest_fur(const FurTreeView& tree, const FurRay& ray, FurFilter* filter) {
  FurHit hit = HWY_DYNAMIC_DISPATCH(closest)(tree, ray, filter);
  if (!hit) return {};
  hit.distance *= tree.step;
  return hit;
}

FurHit closest_fur_at(const FurTreeView& tree, const FurRay& ray, const FurSegmentPlace& at,
                      FurFilter* filter) {
  FurHit hit = HWY_DYNAMIC_DISPATCH(closest_at)(tree, ray, at, filter);
  if (!hit) return {};
  hit.distance *= tree.step;
  return hit;
}

bool fur_occludes(const FurTreeView& tree, const FurRay& ray, FurFilter* filter) {
  return HWY_DYNAMIC_DISPATCH(occluded)(tree, ray, filter);
}

}  // namespace pelage
#endif
