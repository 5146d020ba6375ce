// SPDX-License-Identifier: Apache-2.0
#include "render/accel/chunk_accel.h"

#include <gtest/gtest.h>

#include "base/error.h"
#include "render/accel/flush_denormals.h"
#include "tests/render/chunk_scenes.h"

namespace pelage {
namespace {

class ChunkAccelTest : public testing::Test {
 protected:
  std::unique_ptr<ChunkAccel> make(const TestChunks& chunks, std::vector<ChunkBounds> bounds,
                                   const ChunkAccelOptions& options = {}) {
    return std::make_unique<ChunkAccel>(std::move(bounds), chunks, options, ledger_, Workers(2), progress_);
  }

  /// That both answer every ray alike, down to the last bit.
  void expect_same(const Accel& a, const Accel& b, uint64_t seed, uint64_t rays, int worker = 0) {
    const FlushDenormals flush;
    TraceThread ta, tb;
    ta.worker = worker;
    uint64_t strands = 0, skins = 0, lit = 0;
    for (uint64_t i = 0; i < rays; ++i) {
      Ray ray = i % 2 == 0 ? random_ray(seed, i) : inner_ray(seed, i);
      if (i % 5 == 0) ray.far = 3 + ray.direction.x;
      const Hit ha = a.closest(ray, ta), hb = b.closest(ray, tb);
      ASSERT_EQ(ha.kind, hb.kind) << i;
      ASSERT_EQ(ha.part, hb.part) << i;
      ASSERT_EQ(ha.strand_id, hb.strand_id) << i;
      ASSERT_EQ(ha.segment, hb.segment) << i;
      ASSERT_EQ(ha.distance, hb.distance) << i;
      ASSERT_EQ(ha.u, hb.u) << i;
      ASSERT_EQ(ha.v, hb.v) << i;
      if (ha.kind == HitKind::kStrand) {
        ASSERT_EQ(ta.met.strand.arrays().points, tb.met.strand.arrays().points);
        ASSERT_EQ(ta.met.strand.arrays().ids, tb.met.strand.arrays().ids);
        ++strands;
      } else if (ha.kind == HitKind::kSkin) {
        ASSERT_EQ(ta.met.triangle.positions, tb.met.triangle.positions);
        ++skins;
      }
      const float light = a.transmittance(ray, ta);
      ASSERT_EQ(light, b.transmittance(ray, tb)) << i;
      lit += light > 0;
    }
    EXPECT_GT(strands, rays / 20);
    EXPECT_GT(lit, rays / 20);
    EXPECT_LT(strands + skins, rays);
  }

  /// From within the scene of random_chunks().
  static Ray inner_ray(uint64_t seed, uint64_t index) {
    Ray ray = random_ray(seed, index);
    ray.origin += 3.5f * ray.direction;
    return ray;
  }

  MemoryLedger ledger_;
  NoProgress progress_;
};

/// A scene for every kind of strand.
class ChunkAccelScenes : public ChunkAccelTest, public testing::WithParamInterface<int> {
 protected:
  static RandomChunkOptions scene() {
    RandomChunkOptions o;
    switch (GetParam()) {
      case 0:
        break;
      case 1:
        o.translucent = true;
        break;
      case 2:
        o.motion_keys = 2;
        o.translucent = true;
        break;
      case 3:
        o.motion_keys = 4;
        o.uniform = false;
        break;
      case 4:
        o.basis = CurveBasis::kLinear;
        o.translucent = true;
        break;
      case 5:
        o.basis = CurveBasis::kCatmullRom;
        o.uniform = false;
        break;
      default:
        o.basis = CurveBasis::kBSpline;
        o.uniform = false;
        o.motion_keys = 3;
        break;
    }
    return o;
  }
};

TEST_P(ChunkAccelScenes, AnswersAsOneSceneOverEverything) {
  const TestChunks chunks = random_chunks(7, scene());
  const auto oracle = chunks.oracle(CurveShape::kFlat, ledger_);
  expect_same(*oracle, *make(chunks, chunks.bounds(8)), 1, 2500);        // boxes of parts
  expect_same(*oracle, *make(chunks, chunks.bounds(1, 1.4f)), 2, 2500);  // loose ones
  ChunkAccelOptions eager;
  eager.eager = true;
  expect_same(*oracle, *make(chunks, std::vector<ChunkBounds>(chunks.contents.size()), eager), 3, 2500);
}

INSTANTIATE_TEST_SUITE_P(All, ChunkAccelScenes, testing::Range(0, 7));

}  // namespace
}  // namespace pelage
