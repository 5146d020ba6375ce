// SPDX-License-Identifier: Apache-2.0
#include "render/accel/fur/fur_segment_rays.h"

#include <cstring>

#include <gtest/gtest.h>
#include <hwy/targets.h>

#include "render/accel/flush_denormals.h"
#include "render/accel/fur/fur_leaf.h"
#include "render/accel/fur/fur_ray.h"
#include "render/accel/fur/fur_segment_lookup.h"
#include "tests/render/accel/fur/fur_grooms.h"
#include "tests/support/effort.h"

namespace pelage {
namespace {

constexpr uint64_t kBatches = repetitions(1500);

bool same_bits(const FurHit& a, const FurHit& b) {
  return a.number == b.number &&
         (!a || (std::memcmp(&a.distance, &b.distance, sizeof(float)) == 0 && a.u == b.u && a.h == b.h));
}

/// Up to 16 rays around one ray, some from other places and some along other axes.
std::vector<Ray> rays_around(const Ray& first, TestRandom& random, uint64_t batch) {
  std::vector<Ray> rays(1 + batch % FurSegmentRays::kMax, first);
  for (size_t i = 1; i < rays.size(); ++i) {
    if (batch % 3 == 0) rays[i].origin += 0.01f * random.direction();
    rays[i].direction = (first.direction + 0.02f * random.unit() * random.direction()).normalized();
    if (batch % 11 == 0 && i % 4 == 0) rays[i].direction = random.direction();
  }
  return rays;
}

/// Compares with closest_fur_at() on one instruction set. Returns how many hits were the same.
size_t compare(const GroomShape& shape, int64_t target) {
  const FlushDenormals flush;
  const Strands strands = random_groom(shape, 300, 1);
  const SnappedStrands snapped(strands, FurGrid(shape.width, shape.centre));
  FurTreeOptions options;
  options.build.rotation = FurRotation::kWhenUseful;
  const FurTree tree(snapped, options);
  const FurTreeView& view = tree.view();
  const FurSegmentLookup places(view, snapped.segment_count());
  TestRandom random(3);
  size_t same = 0;
  for (uint64_t batch = 0; batch < kBatches; ++batch) {
    const Ray first = ray_at_groom(shape, strands, random, batch);
    const FurHit seen = tree.closest(first, {});
    if (!seen) continue;
    const std::vector<Ray> rays = rays_around(first, random, batch);
    std::vector<const Ray*> pointers;
    for (const Ray& ray : rays) pointers.push_back(&ray);
    const FurSegmentLookup::Place place = places.find(view, seen.number);
    const SnappedSegment segment = read_block(place.block, place.wide, place.lane, 0);
    std::vector<FurHit> hits(rays.size());
    hwy::SetSupportedTargetsForTest(target);
    hwy::GetChosenTarget().Update(target);
    const uint32_t undecided = FurSegmentRays::closest(view, segment, seen.number, pointers, hits.data());
    hwy::SetSupportedTargetsForTest(0);
    hwy::GetChosenTarget().Update(hwy::SupportedTargets());
    for (size_t i = 0; i < rays.size(); ++i) {
      if ((undecided >> i & 1) != 0) continue;
      FurRay prepared;
      FurHit expected;
      if (prepared.prepare(view, rays[i], {}))
        expected = closest_fur_at(view, prepared, {place.block, place.wide, seen.number}, nullptr);
      EXPECT_TRUE(same_bits(expected, hits[i])) << shape.name << ' ' << batch << ' ' << i;
      same += expected ? 1 : 0;
    }
  }
  return same;
}

TEST(FurSegmentRays, HaveTheSameHitsAsSingleRaysOnEveryInstructionSet) {
  for (const int64_t target : {HWY_EMU128, HWY_SSE4, HWY_AVX2, HWY_AVX3}) {
    if (target != HWY_EMU128 && (hwy::SupportedTargets() & target) == 0) continue;
    for (const GroomShape& shape : groom_shapes_at_any_distance()) {
      if (shape.motion_keys > 1) continue;
      EXPECT_GT(compare(shape, target), kBatches / 50) << shape.name;
    }
  }
}

}  // namespace
}  // namespace pelage
