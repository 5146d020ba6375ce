// SPDX-License-Identifier: Apache-2.0
// The fur tree beside Embree's flat curves: the same ribbons by other means.
#include <gtest/gtest.h>

#include "base/parallel.h"
#include "render/accel/flush_denormals.h"
#include "render/accel/fur/fur_tree.h"
#include "tests/render/accel/embree_accel.h"
#include "tests/render/accel/fur/fur_grooms.h"

namespace pelage {
namespace {

constexpr size_t kStrands = 1500;
constexpr uint64_t kRays = 30000;

GroomShape dense_fur() {
  GroomShape shape;
  shape.width = 0.01f;
  shape.curl = 0.08f;
  shape.turns = 1.5f;
  return shape;
}

/// Rays from outside, and rays from within whose start is clear of every strand by two radii and more.
std::vector<Ray> clear_rays(const Strands& strands, uint64_t seed) {
  TestRandom random(seed);
  std::vector<Ray> rays;
  for (uint64_t i = 0; i < kRays; ++i) {
    Ray ray;
    const bool outside = i % 3 != 0;
    ray.origin = outside ? 4.0f * random.direction() : 2.0f * random.unit3() - V3f(1);
    ray.direction =
        outside ? (1.6f * random.unit3() - V3f(0.8f) - ray.origin).normalized() : random.direction();
    bool is_clear = true;
    for (size_t s = 0; !outside && is_clear && s < strands.strand_count(); ++s) {
      const uint32_t first = strands.first_point(s), points = strands.strand_points(s);
      for (uint32_t k = 0; is_clear && k + 1 < points; ++k) {
        // Within two radii of the curve is within the control polygon's reach of it.
        const V3f a = strands.point(first + k), b = strands.point(first + k + 1);
        const V3f along = b - a;
        const float t = std::clamp((ray.origin - a).dot(along) / along.length2(), 0.0f, 1.0f);
        is_clear = (ray.origin - (a + t * along)).length() > 0.05f;
      }
    }
    if (is_clear) rays.push_back(ray);
  }
  return rays;
}

TEST(FurBesideEmbree, meets_the_same_segments) {
  const FlushDenormals flush;
  const Strands strands = random_groom(dense_fur(), kStrands, 11);
  const SnappedStrands snapped(strands, FurGrid(dense_fur().width));
  const FurTree tree(snapped, {});
  const std::vector<Ray> rays = clear_rays(strands, 12);
  ASSERT_GT(rays.size(), kRays / 2);
  const Workers workers(1);
  double different[3] = {};
  size_t met = 0, turned = 0;
  for (int rate : {4, 8, 16}) {
    EmbreeOptions options;
    options.tessellation_rate = rate;
    const EmbreeAccel embree({{&strands, 0, {}}}, {}, options, workers);
    TraceThread thread;
    size_t others = 0;
    met = 0;
    for (const Ray& ray : rays) {
      const Hit expected = embree.closest(ray, thread);
      const FurHit hit = tree.closest(ray, {});
      met += expected || hit;
      bool same = bool(expected) == bool(hit);
      if (same && hit) {
        const SnappedStrands::Place place = snapped.locate(hit.number);
        const float from_start = static_cast<float>(place.segment) + hit.u,
                    expected_from_start = static_cast<float>(expected.segment) + expected.u;
        // Beside a joint either of its segments is the same place.
        same = strands.id(place.strand) == expected.strand_id &&
               std::abs(from_start - expected_from_start) < 0.02f;
        if (same && rate == 16) turned += std::abs(hit.h - expected.v) > 0.1f ? 1 : 0;
      }
      others += same ? 0 : 1;
    }
    different[rate == 4 ? 0 : rate == 8 ? 1 : 2] = static_cast<double>(others);
  }
  EXPECT_GT(met, rays.size() / 4);
  EXPECT_LT(different[2], 0.01 * static_cast<double>(met));
  // Embree's pieces stray from the curve by the square of their length.
  EXPECT_GT(different[0], 3 * different[1]);
  EXPECT_GT(different[1], 2 * different[2]);
  // Across, they differ where a strand runs almost along the ray.
  EXPECT_LT(static_cast<double>(turned), 1e-3 * static_cast<double>(met));
}

}  // namespace
}  // namespace pelage
