// SPDX-License-Identifier: Apache-2.0
// Tests render/accel/sight.h with the accelerator that uses it.
#include <gtest/gtest.h>

#include "render/accel/sight.h"
#include "tests/render/accel/chunk_accel_fixture.h"
#include "tests/support/effort.h"

namespace pelage {
namespace {

constexpr float kInfinity = std::numeric_limits<float>::infinity();

/// Chunks of which each has a range.
class RangedChunks final : public ChunkGrower {
 public:
  RangedChunks(const TestChunks& chunks, std::vector<SightRange> ranges)
      : chunks_(chunks), ranges_(std::move(ranges)) {}

  ChunkContents grow(uint32_t chunk) const override { return chunks_.grow(chunk); }
  bool is_skin(uint32_t chunk) const override { return chunks_.is_skin(chunk); }
  uint32_t part(uint32_t chunk) const override { return chunks_.part(chunk); }
  ChunkCounts counts(uint32_t chunk) const override { return chunks_.counts(chunk); }
  StrandScale scale(uint32_t chunk) const override { return chunks_.scale(chunk); }
  SightRange range(uint32_t chunk) const override { return ranges_[chunk]; }

 private:
  const TestChunks& chunks_;
  std::vector<SightRange> ranges_;
};

/// Three kinds of chunks: those that all rays see, skins among them; those that secondary rays see up to
/// kSwitch only; and those that only secondary rays see, from there on.
constexpr float kSwitch = 0.4f;
SightRange range_of(const TestChunks& chunks, uint32_t chunk) {
  if (chunks.is_skin(chunk) || chunk % 3 == 0) return {};
  return chunk % 3 == 1 ? SightRange{0, kSwitch} : SightRange{kSwitch, kInfinity};
}

/// The slow truth: accelerators without ranges over subsets of the chunks, asked one after the other.
class Subset {
 public:
  template <class Wanted>
  Subset(const TestChunks& all, const Wanted& wanted, const Job& job) {
    for (uint32_t chunk = 0; chunk < all.contents.size(); ++chunk) {
      if (wanted(range_of(all, chunk))) chunks_.contents.push_back(all.contents[chunk]);
    }
    ResidentChunksOptions options;
    options.kind = AccelKind::kFur;
    options.eager = true;
    accel_.emplace(std::vector<ChunkBounds>(chunks_.contents.size()), chunks_, options, job);
  }
  Hit closest(Ray ray, float near, float far, TraceThread& thread) const {
    return accel_->closest(part(ray, near, far), thread);
  }
  float light(Ray ray, float near, float far, TraceThread& thread) const {
    return accel_->transmittance(part(ray, near, far), thread);
  }

 private:
  static Ray part(Ray ray, float near, float far) {
    ray.near = std::max(ray.near, near);
    ray.far = std::min(ray.far, far);
    return ray;
  }
  TestChunks chunks_;
  std::optional<ChunkAccel> accel_;
};

class OcclusionDetailTest : public ChunkAccelTest {
 protected:
  struct Scene {
    explicit Scene(const RandomChunkOptions& options) : chunks(random_chunks(3, options)) {
      std::vector<SightRange> ranges;
      for (uint32_t chunk = 0; chunk < chunks.contents.size(); ++chunk)
        ranges.push_back(range_of(chunks, chunk));
      ranged = std::make_unique<RangedChunks>(chunks, std::move(ranges));
    }
    TestChunks chunks;
    std::unique_ptr<RangedChunks> ranged;
  };
  std::unique_ptr<ChunkAccel> accel_of(const Scene& scene, ResidentChunksOptions options) {
    options.kind = AccelKind::kFur;
    return std::make_unique<ChunkAccel>(scene.chunks.measured_bounds(1), *scene.ranged, options, job());
  }
  Job job() { return {workers_, ledger_, progress_}; }

  /// That the accelerator answers as the truth does.
  void expect_truth(const Scene& scene, const Accel& accel, bool secondary, bool distant) {
    const Subset near(
        scene.chunks, [](const SightRange& r) { return !r.is_distant(); }, job());
    const Subset far(
        scene.chunks, [](const SightRange& r) { return r.is_distant() || r.to == kInfinity; }, job());
    const float until = !secondary ? kInfinity : distant ? 0 : kSwitch;
    const FlushDenormals flush;
    TraceThread thread;
    const uint64_t rays = repetitions(3000);
    uint64_t near_hits = 0, far_hits = 0;
    for (uint64_t i = 0; i < rays; ++i) {
      Ray ray = inner_ray(3, i);
      if (i % 4 == 0) ray.far = 0.3f + 0.4f * std::abs(ray.direction.x);
      ray.secondary = secondary;
      ray.start.distant = distant;
      Hit truth = near.closest(ray, 0, until, thread);
      near_hits += truth.kind == HitKind::kStrand;
      if (!truth && until < kInfinity) {
        truth = far.closest(ray, until, kInfinity, thread);
        far_hits += truth.kind == HitKind::kStrand;
      }
      const Hit hit = accel.closest(ray, thread);
      ASSERT_EQ(hit.kind, truth.kind) << i;
      ASSERT_EQ(hit.strand_id, truth.strand_id) << i;
      ASSERT_EQ(hit.distance, truth.distance) << i;
      ASSERT_EQ(hit.v, truth.v) << i;
      const float light = near.light(ray, 0, until, thread) *
                          (until < kInfinity ? far.light(ray, until, kInfinity, thread) : 1);
      // Products of the same opacities in another order.
      ASSERT_NEAR(accel.transmittance(ray, thread), light, 1e-5f) << i;
    }
    EXPECT_EQ(near_hits > rays / 20, until > 0);
    EXPECT_EQ(far_hits > rays / 20, until < kInfinity);
  }
};

TEST_F(OcclusionDetailTest, RaysSeeWhatTheirRangesSay) {
  for (const int kind : {0, 1, 2}) {
    const Scene scene(scene_of_kind(kind));
    const auto accel = accel_of(scene, {});
    expect_truth(scene, *accel, false, false);
    expect_truth(scene, *accel, true, false);
    expect_truth(scene, *accel, true, true);
  }
}

TEST_F(OcclusionDetailTest, NeitherMemoryNorResidencyChangesAHit) {
  const Scene scene(scene_of_kind(1));
  ResidentChunksOptions eager, lazy;
  eager.eager = true;
  const auto all = accel_of(scene, eager);
  int64_t fixed = 0, working_set = 0;
  {
    const auto unlimited = accel_of(scene, lazy);
    fixed = ledger_.budgeted();
    secondary_ = true;
    expect_same(*all, *unlimited, 5, repetitions(1000));
    working_set = unlimited->chunks().counts().working_set_bytes;
  }
  size_t largest = 0;
  for (uint32_t chunk = 0; chunk < scene.chunks.contents.size(); ++chunk) {
    const ChunkCounts counts = scene.chunks.counts(chunk);
    largest = std::max(largest, scene.chunks.is_skin(chunk)
                                    ? EmbreeChunk::bytes_bound(counts) + part_bounds_scratch(counts)
                                    : FurChunk::bytes_bound(counts, FurChunkOptions()));
  }
  lazy.memory_limit = static_cast<uint64_t>(fixed + 16384) + std::max<uint64_t>(largest, working_set / 4);
  const auto some = accel_of(scene, lazy);
  expect_same(*all, *some, 5, 60);
  EXPECT_GT(some->chunks().counts().evictions, 0);
  secondary_ = false;
  expect_same(*all, *some, 6, 60);
}

TEST_F(OcclusionDetailTest, NoRayGrowsAChunkThatItDoesNotSee) {
  const Scene scene(scene_of_kind(0));
  const FlushDenormals flush;
  TraceThread thread;
  for (const bool secondary : {false, true}) {
    const auto accel = accel_of(scene, {});
    for (uint64_t i = 0; i < repetitions(2000); ++i) {
      Ray ray = inner_ray(3, i);
      ray.secondary = secondary;
      ray.start.distant = secondary;
      accel->closest(ray, thread);
      accel->transmittance(ray, thread);
    }
    uint32_t grown = 0;
    for (uint32_t chunk = 0; chunk < scene.chunks.contents.size(); ++chunk) {
      const SightRange range = range_of(scene.chunks, chunk);
      if (!accel->chunks().is_resident(chunk)) continue;
      ++grown;
      EXPECT_FALSE(secondary ? range.to < kInfinity : range.is_distant()) << chunk;
    }
    EXPECT_GT(grown, scene.chunks.contents.size() / 2);
  }
}

TEST_F(OcclusionDetailTest, HitsTellWhetherTheyAreDistantAndRaysAreCounted) {
  const Scene scene(scene_of_kind(0));
  const auto accel = accel_of(scene, {});
  const FlushDenormals flush;
  TraceThread thread;
  int64_t rays = 0, distant = 0;
  for (uint64_t i = 0; i < 1000; ++i) {
    Ray ray = inner_ray(3, i);
    EXPECT_FALSE(accel->closest(ray, thread).start.distant);
    EXPECT_EQ(thread.counts.rays_near + thread.counts.rays_far, rays);
    ray.secondary = true;
    const Hit hit = accel->closest(ray, thread);
    EXPECT_EQ(thread.counts.rays_near + thread.counts.rays_far, ++rays);
    if (!hit) continue;
    // A strand that all rays see is never distant.
    const bool expected = hit.kind == HitKind::kSkin ? hit.distance >= kSwitch
                                                     : range_of(scene.chunks, hit.start.chunk).is_distant();
    EXPECT_EQ(hit.start.distant, expected);
    distant += expected;
    ray.start.distant = true;
    if (const Hit again = accel->closest(ray, thread)) {
      EXPECT_TRUE(again.start.distant);
    }
    ++rays;
  }
  EXPECT_GT(distant, 50);
  EXPECT_GT(thread.counts.rays_near, 50);
  EXPECT_GT(thread.counts.rays_far, 50);
}

}  // namespace
}  // namespace pelage
