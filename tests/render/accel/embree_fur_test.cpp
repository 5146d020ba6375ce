// SPDX-License-Identifier: Apache-2.0
#include "render/accel/embree_fur.h"

#include <cmath>

#include <gtest/gtest.h>

#include "base/parallel.h"
#include "render/accel/embree_accel.h"
#include "render/accel/flush_denormals.h"
#include "tests/render/accel/fur/fur_grooms.h"

namespace pelage {
namespace {

/// Bare curves beside the accelerator that renders: the same curves at the same distances.
TEST(EmbreeFur, MeetsWhatTheAcceleratorMeets) {
  const FlushDenormals flush;
  const Strands strands = random_groom(GroomShape(), 400, 21);
  const Workers workers(1);
  MemoryLedger ledger;
  const EmbreeAccel truth({{&strands, 0, {}}}, {}, {}, ledger, workers);
  const EmbreeFur fast(strands, false, EmbreeOptions().tessellation_rate, ledger, workers);
  const EmbreeFur compact(strands, true, EmbreeOptions().tessellation_rate, ledger, workers);
  TestRandom random(22);
  TraceThread thread;
  int met = 0;
  for (int i = 0; i < 20000; ++i) {
    Ray ray;
    ray.origin = 4.0f * random.direction();
    ray.direction = (1.6f * random.unit3() - V3f(0.8f) - ray.origin).normalized();
    const Hit hit = truth.closest(ray, thread);
    ASSERT_EQ(fast.occluded(ray), bool(hit));
    ASSERT_EQ(std::isfinite(fast.closest(ray)), bool(hit));
    if (hit) {
      ASSERT_NEAR(fast.closest(ray) / hit.distance, 1, 1e-5f);
    }
    ASSERT_EQ(compact.occluded(ray), std::isfinite(compact.closest(ray)));
    met += bool(hit);
    ray.far = 0.5f * hit.distance;
    ASSERT_FALSE(fast.occluded(ray));
  }
  EXPECT_GT(met, 500);
  EXPECT_LT(met, 19500);
}

TEST(EmbreeFur, IsChargedToTheChunks) {
  const Strands strands = random_groom(GroomShape(), 400, 21);
  const Workers workers(1);
  MemoryLedger ledger;
  {
    const EmbreeFur fur(strands, false, 4, ledger, workers);
    EXPECT_GT(ledger.current(MemoryTag::kChunks), 0);
  }
  EXPECT_EQ(ledger.current(MemoryTag::kChunks), 0);
}

}  // namespace
}  // namespace pelage
