// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <atomic>
#include <string_view>

#include <gtest/gtest.h>

#include "base/progress.h"
#include "render/accel/flush_denormals.h"
#include "tests/render/accel/chunk_scenes.h"

namespace pelage {

/// Counts what went wrong.
class WarningCounter final : public Progress {
 public:
  void begin(std::string_view, double) override {}
  void advance(double) override {}
  void end() override {}
  void warn(std::string_view) override { ++warnings; }
  bool cancelled() const override { return false; }

  std::atomic<int> warnings{0};
};

class ChunkAccelTest : public testing::Test {
 protected:
  std::unique_ptr<ChunkAccel> make(const TestChunks& chunks, std::vector<ChunkBounds> bounds,
                                   const ChunkAccelOptions& options = {}) {
    return std::make_unique<ChunkAccel>(std::move(bounds), chunks, options,
                                        Job{workers_, ledger_, progress_});
  }

  /// That both answer every ray alike, down to the last bit. The accelerators may hold the strands in other
  /// chunks, so that each goes on from its own hits.
  void expect_same(const Accel& a, const Accel& b, uint64_t seed, uint64_t rays, int worker = 0) {
    const FlushDenormals flush;
    TraceThread ta, tb;
    ta.worker = tb.worker = worker;
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
      if (!ha) continue;
      // On from there: what is near a ray's start may not be seen.
      Ray onward = ray;
      onward.origin += ha.distance * ray.direction;
      onward.direction = random_ray(seed + 1, i).direction;
      Ray onward_a = onward, onward_b = onward;
      // One scene over everything knows of no strand that a ray starts on.
      if (ha.start.chunk != StrandStart::kNone) onward_a.start = ha.start, onward_b.start = hb.start;
      const Hit na = a.closest(onward_a, ta), nb = b.closest(onward_b, tb);
      ASSERT_EQ(na.strand_id, nb.strand_id) << i;
      ASSERT_EQ(na.distance, nb.distance) << i;
      ASSERT_EQ(a.transmittance(onward_a, ta), b.transmittance(onward_b, tb)) << i;
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

  Workers workers_{2};
  MemoryLedger ledger_;
  WarningCounter progress_;
};

/// Scenes of every kind of strand.
inline constexpr int kSceneKinds = 7;
inline RandomChunkOptions scene_of_kind(int kind) {
  RandomChunkOptions o;
  switch (kind) {
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

}  // namespace pelage
