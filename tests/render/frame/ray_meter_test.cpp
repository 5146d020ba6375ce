// SPDX-License-Identifier: Apache-2.0
#include "render/frame/ray_meter.h"

#include <vector>

#include <gtest/gtest.h>

#include "render/frame/frame_statistics.h"

namespace pelage {
namespace {

/// Clocks that only the test advances.
struct TestClocks {
  static double wall_s() { return wall; }
  static double cpu_s() { return cpu; }
  static void work(double seconds) { wall += seconds, cpu += seconds; }
  static void sleep(double seconds) { wall += seconds; }
  static inline double wall = 0, cpu = 0;
};
using Meter = RayMeterOf<TestClocks>;

constexpr RayKind kKinds[] = {RayKind::kCamera, RayKind::kShadow, RayKind::kIndirect};
constexpr double kRay_s = 2e-6;

/// Traces a ray that takes `seconds`, with the clocks read around every ray as the slow truth.
double trace(Meter& meter, RayKind kind, double seconds) {
  const double began = TestClocks::cpu_s();
  const int answer = meter.measure(kind, TraceCounts{}, [&] {
    TestClocks::work(seconds);
    return 42;
  });
  EXPECT_EQ(answer, 42);
  return TestClocks::cpu_s() - began;
}

TEST(RayMeter, AttributesTimeToTheKindOfRay) {
  Meter meter;
  double truth[3] = {};
  for (int i = 0; i < 12000; ++i) {
    const auto kind = static_cast<size_t>(i % 4 == 3 ? 1 : i % 3);
    // The time of a ray varies with periods that are common in tiles.
    truth[kind] +=
        trace(meter, kKinds[kind], kRay_s * static_cast<double>(1 + kind * 4 + i % 16 + i / 64 % 2));
  }
  EXPECT_EQ(meter.counts().total(), 12000);
  EXPECT_EQ(meter.counts().shadow, 6000);
  // At least 49 samples that spread over the period: within 5 % of the mean.
  for (size_t kind = 0; kind < 3; ++kind)
    EXPECT_NEAR(meter.seconds(kKinds[kind]), truth[kind], 0.05 * truth[kind]);
}

TEST(RayMeter, CountsASlowRayOnce) {
  Meter meter;
  meter.begin();
  double truth = trace(meter, RayKind::kShadow, 5e-3);
  for (int i = 1; i < 1000; ++i) truth += trace(meter, RayKind::kShadow, kRay_s);
  EXPECT_NEAR(meter.seconds(RayKind::kShadow), truth, 1e-9);
}

TEST(RayMeter, LeavesOutTheTimeThatAThreadIsSuspended) {
  for (const double slow_s : {0.0, 5e-3}) {
    Meter meter;
    meter.begin();
    double truth = 0;
    for (int i = 0; i < 1000; ++i) {
      meter.measure(RayKind::kCamera, TraceCounts{}, [&] {
        const bool is_measured = i % Meter::kStride == 0;
        const double work_s = i == Meter::kStride ? kRay_s + slow_s : kRay_s;
        TestClocks::work(work_s);
        truth += work_s;
        if (is_measured && i < 200) TestClocks::sleep(0.1);
        return 0;
      });
    }
    EXPECT_NEAR(meter.seconds(RayKind::kCamera), truth, 2 * kRay_s) << slow_s;
  }
}

TEST(RayMeter, LeavesOutRaysThatMayGrowAChunk) {
  Meter meter;
  TraceCounts counts;
  for (int i = 0; i < 1000; ++i) {
    meter.measure(RayKind::kCamera, counts, [&] {
      const bool grows = i < 10;
      if (grows) ++counts.absent_visits;
      TestClocks::work(grows ? 9e-4 : kRay_s);
      return 0;
    });
  }
  EXPECT_NEAR(meter.seconds(RayKind::kCamera), 1000 * kRay_s, 1e-9);
  EXPECT_EQ(meter.counts().camera, 1000);
}

TEST(RayMeter, SumsThreads) {
  Meter one, many[4], sum;
  for (int i = 0; i < 4 * 600; ++i) {
    const RayKind kind = kKinds[i % 3];
    trace(one, kind, kRay_s);
    trace(many[i / 600], kind, kRay_s);
  }
  for (const Meter& meter : many) sum += meter;
  for (const RayKind kind : kKinds) EXPECT_NEAR(sum.seconds(kind), one.seconds(kind), 1e-9);
  EXPECT_EQ(sum.counts().indirect, one.counts().indirect);
}

TEST(RayMeter, KnowsNoTimeWithoutRays) {
  EXPECT_EQ(Meter().seconds(RayKind::kCamera), 0);
  EXPECT_EQ(Meter().counts().total(), 0);
}

/// A real meter whose camera rays took some time.
RayMeter some_rays() {
  RayMeter meter;
  volatile int sink = 0;
  meter.measure(RayKind::kCamera, TraceCounts{}, [&] {
    for (int i = 0; i < 1000; ++i) sink = i;
    return 0;
  });
  return meter;
}

TEST(RenderSeconds, AddUpToTheCpuTimeWithoutGrowth) {
  const TileCosts tiles{some_rays(), {}, 7};
  const RenderSeconds parts = render_seconds(tiles, 3);
  EXPECT_EQ(parts.camera_rays, tiles.rays.seconds(RayKind::kCamera));
  EXPECT_EQ(parts.shadow_rays, 0);
  EXPECT_DOUBLE_EQ(parts.total(), 4);
  RenderSeconds twice = parts;
  twice += parts;
  EXPECT_DOUBLE_EQ(twice.total(), 8);
}

TEST(RenderSeconds, NeverExceedTheCpuTime) {
  const RayMeter rays = some_rays();
  const double rays_s = rays.seconds(RayKind::kCamera);
  ASSERT_GT(rays_s, 0);
  EXPECT_DOUBLE_EQ(render_seconds({rays, {}, 3 + rays_s / 4}, 3).total(), rays_s / 4);
  EXPECT_EQ(render_seconds({rays, {}, rays_s / 4}, 1).total(), 0);
}

}  // namespace
}  // namespace pelage
