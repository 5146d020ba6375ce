// SPDX-License-Identifier: Apache-2.0
#include "render/accel/chunk_accel.h"

#include <algorithm>

#include <gtest/gtest.h>

#include "base/error.h"
#include "render/accel/flush_denormals.h"
#include "tests/render/accel/chunk_accel_fixture.h"
#include "tests/support/effort.h"

namespace pelage {
namespace {

/// A scene for every kind of strand.
class ChunkAccelScenes : public ChunkAccelTest, public testing::WithParamInterface<int> {};

TEST_P(ChunkAccelScenes, AnswersAsOneSceneOverEverything) {
  const TestChunks chunks = random_chunks(7, scene_of_kind(GetParam()));
  const auto oracle = chunks.oracle(CurveShape::kFlat);
  expect_same(*oracle, *make(chunks, chunks.bounds(8)), 1, repetitions(2500));        // boxes of parts
  expect_same(*oracle, *make(chunks, chunks.bounds(1, 1.4f)), 2, repetitions(2500));  // loose ones
  for (int keys : {1, 2})
    expect_same(*oracle, *make(chunks, chunks.measured_bounds(keys)), 4, repetitions(1500));
  ResidentChunksOptions eager;
  eager.eager = true;
  expect_same(*oracle, *make(chunks, std::vector<ChunkBounds>(chunks.contents.size()), eager), 3,
              repetitions(2500));
}

INSTANTIATE_TEST_SUITE_P(All, ChunkAccelScenes, testing::Range(0, kSceneKinds));

// Embree's round curves look for a hit only in front of the ray's far end; what they find must not depend on
// what was met before.
TEST_F(ChunkAccelTest, RoundStrandsAnswerAsOneScene) {
  for (int motion_keys : {1, 3}) {
    for (bool uniform : {true, false}) {
      RandomChunkOptions o;
      o.motion_keys = motion_keys;
      o.uniform = uniform;
      const TestChunks chunks = random_chunks(3, o);
      const auto oracle = chunks.oracle(CurveShape::kRound);
      ResidentChunksOptions options;
      options.chunk.shape = CurveShape::kRound;
      expect_same(*oracle, *make(chunks, chunks.bounds(8), options), 5, repetitions(3000));
      expect_same(*oracle, *make(chunks, chunks.measured_bounds(2), options), 6, repetitions(3000));
    }
  }
}

TEST_F(ChunkAccelTest, EqualDistancesAreDecidedByStrandIdAcrossChunks) {
  for (float x = 0.1f; x < 6.9f; x += 0.05f) {
    const SkinMesh skin = quad_as_far_as_strand(x);
    for (int order = 0; order < 4; ++order) {
      TestChunks chunks;
      if (order & 2) chunks.add_skin(skin, 0);
      chunks.add_fur(ladder(2, order & 1 ? 8 : 3), 0);
      chunks.add_fur(ladder(2, order & 1 ? 3 : 8), 0);
      if (!(order & 2)) chunks.add_skin(skin, 0);
      const auto accel = make(chunks, chunks.bounds(4));
      TraceThread thread;
      const Hit hit = accel->closest(along_z(x), thread);
      ASSERT_EQ(hit.kind, HitKind::kStrand) << x;
      EXPECT_EQ(hit.strand_id, 3u) << x;
      EXPECT_EQ(thread.hit_geometry.strand.id(0), 3u);
    }
  }
}

// A mesh whose faces are all holes is a skin without triangles, not fur.
TEST_F(ChunkAccelTest, SkinsWithoutTrianglesAreSkins) {
  for (const AccelKind kind : {AccelKind::kEmbree, AccelKind::kFur}) {
    for (const bool eager : {false, true}) {
      for (const bool alone : {false, true}) {
        TestChunks chunks;
        chunks.add_skin(SkinMesh{}, 0);
        if (!alone) chunks.add_fur(ladder(2), 0);
        ResidentChunksOptions options;
        options.kind = kind;
        options.eager = eager;
        // As those of a skin: around the control points, whatever is visible.
        std::vector<ChunkBounds> bounds(chunks.contents.size());
        for (ChunkBounds& box : bounds) box.boxes = {Box3f(V3f(-1), V3f(8, 1, 2))};
        const auto accel = make(chunks, std::move(bounds), options);
        TraceThread thread;
        const Hit hit = accel->closest(along_z(1.5f), thread);
        EXPECT_EQ(hit.kind, alone ? HitKind::kNone : HitKind::kStrand);
        EXPECT_EQ(accel->transmittance(along_z(1.5f), thread), alone ? 1 : 0);
        EXPECT_FALSE(accel->closest(along_z(20), thread));
      }
    }
  }
}

// Where rays of Embree's begin before theirs, and which strand they leave, depends on the coat, not on
// chunks.
TEST_F(ChunkAccelTest, NumbersOfChunksChangeNoAnswer) {
  for (int kind = 0; kind < kSceneKinds; ++kind) {
    SCOPED_TRACE(kind);
    TestChunks chunks = random_chunks(23, scene_of_kind(kind));
    chunks.widest = 0.03f;
    TestChunks others = chunks;
    std::reverse(others.contents.begin(), others.contents.end());
    expect_same(*make(chunks, chunks.bounds(8)), *make(others, others.bounds(8)), 7, repetitions(1500));
  }
}

TEST_F(ChunkAccelTest, BudgetsChangeNoAnswer) {
  RandomChunkOptions o;
  o.chunks = 40;
  o.strands = 40;
  o.translucent = true;
  const TestChunks chunks = random_chunks(17, o);
  const auto oracle = chunks.oracle(CurveShape::kFlat);
  int64_t working_set = 0, fixed = 0;
  size_t largest = 0;
  {
    const auto accel = make(chunks, chunks.bounds(8));
    fixed = ledger_.budgeted();
    expect_same(*oracle, *accel, 1, repetitions(2000));
    working_set = accel->chunks().counts().working_set_bytes;
    EXPECT_EQ(accel->chunks().counts().overruns, 0);
    EXPECT_EQ(accel->chunks().counts().evictions, 0);
    for (uint32_t c = 0; c < chunks.contents.size(); ++c) {
      largest = std::max(largest,
                         EmbreeChunk::bytes_bound(chunks.counts(c)) + part_bounds_scratch(chunks.counts(c)));
    }
  }
  for (int threads : {1, 4}) {
    for (int percent : {50, 25, 10, 5}) {
      ResidentChunksOptions options;
      options.threads = threads;
      options.memory_limit = static_cast<uint64_t>(
          fixed + 16384 + std::max(working_set * percent / 100, threads * static_cast<int64_t>(largest)));
      const auto accel =
          make(chunks, percent == 25 ? chunks.bounds(1, 1.2f) : chunks.measured_bounds(percent == 10 ? 2 : 1),
               options);
      Workers(threads).for_each(
          4, 1, [&](WorkRange range) { expect_same(*oracle, *accel, 100 + range.begin, 20, range.worker); });
      const ResidencyCounts counts = accel->chunks().counts();
      EXPECT_EQ(counts.overruns, 0);
      EXPECT_GT(counts.evictions, 0);
      EXPECT_GT(counts.touched, 10);
    }
  }
  EXPECT_LE(ledger_.current(MemoryTag::kChunks), fixed);  // only the oracle is left
}

TEST_F(ChunkAccelTest, ErrorsOfTheGrowerReachWhoTraces) {
  TestChunks chunks;
  for (uint64_t i = 0; i < 3; ++i) chunks.add_fur(ladder(2, 10 * i), 0);
  chunks.fails_at = 1;
  const auto accel = make(chunks, chunks.bounds(4));
  TraceThread thread;
  EXPECT_THROW(accel->closest(along_z(3), thread), std::runtime_error);
  EXPECT_THROW(accel->closest(along_z(3), thread), std::runtime_error);
  chunks.contents.erase(chunks.contents.begin());
  chunks.fails_at = 0;  // the first that is visited; an opaque one before it would have ended the ray
  const auto fresh = make(chunks, chunks.bounds(4));
  EXPECT_THROW(fresh->transmittance(along_z(3), thread), std::runtime_error);
  EXPECT_FALSE(accel->closest(along_z(-3), thread));
  ResidentChunksOptions eager;
  eager.eager = true;
  EXPECT_THROW(make(chunks, chunks.bounds(4), eager), std::runtime_error);
}

TEST_F(ChunkAccelTest, TooSmallBudgetsAreRefused) {
  const TestChunks chunks = random_chunks(1, {});
  for (bool eager : {false, true}) {
    ResidentChunksOptions options;
    options.eager = eager;
    options.memory_limit = 100000;
    try {
      make(chunks, chunks.bounds(4), options);
      FAIL() << "a budget below one chunk was not noticed";
    } catch (const Error& error) {
      EXPECT_EQ(error.kind(), ErrorKind::kMemory);
    }
    EXPECT_EQ(ledger_.current(MemoryTag::kChunks), 0);
  }
}

TEST_F(ChunkAccelTest, ChunksThatNoRayReachesAreNotGrown) {
  const TestChunks chunks = random_chunks(5, {});
  const auto accel = make(chunks, chunks.bounds(8));
  TraceThread thread;
  Ray away;
  away.origin = {20, 0, 0};
  away.direction = {1, 0, 0};
  EXPECT_FALSE(accel->closest(away, thread));
  EXPECT_EQ(accel->chunks().counts().expansions, 0);
  EXPECT_GT(thread.counts.box_tests, 0);
  EXPECT_EQ(thread.counts.chunk_visits, 0);

  // What a loose box let grow once is not grown again for rays that its own boxes refuse.
  const auto loose = make(chunks, chunks.bounds(1, 6));
  Ray beside;
  beside.origin = {2.9f, 2.9f, -20};
  EXPECT_FALSE(loose->closest(beside, thread));
  const int64_t visits = thread.counts.chunk_visits;
  EXPECT_GT(visits, 0);
  EXPECT_FALSE(loose->closest(beside, thread));
  EXPECT_EQ(loose->chunks().counts().false_expansions, loose->chunks().counts().expansions);
}

TEST_F(ChunkAccelTest, CountsVisitsOfAbsentChunks) {
  TestChunks chunks;
  chunks.add_fur(ladder(2), 0);
  const auto accel = make(chunks, chunks.bounds(4));
  TraceThread thread;
  EXPECT_TRUE(accel->closest(along_z(1.5f), thread));
  EXPECT_EQ(thread.counts.absent_visits, 1);
  EXPECT_TRUE(accel->closest(along_z(2.5f), thread));
  EXPECT_EQ(accel->transmittance(along_z(2.5f), thread), 0);
  EXPECT_EQ(thread.counts.absent_visits, 1);
  EXPECT_EQ(thread.counts.chunk_visits, 3);
}

TEST_F(ChunkAccelTest, RaysThatAreNotFiniteMeetNothing) {
  TestChunks chunks;
  chunks.add_fur(ladder(2), 0);
  const auto accel = make(chunks, chunks.bounds(4));
  TraceThread thread;
  Ray ray = along_z(3);
  ASSERT_TRUE(accel->closest(ray, thread));
  ray.direction.x = std::numeric_limits<float>::quiet_NaN();
  EXPECT_FALSE(accel->closest(ray, thread));
  EXPECT_EQ(accel->transmittance(ray, thread), 1.0f);
}

// A ray that finds nothing grown: chunks wait for each other, and their boxes do not come in order.
TEST_F(ChunkAccelTest, AnswersAsOneSceneWhereNothingIsGrownYet) {
  RandomChunkOptions crowded;
  crowded.strands = 500;
  const TestChunks chunks = random_chunks(7, crowded);
  const auto oracle = chunks.oracle(CurveShape::kFlat);
  const FlushDenormals flush;
  const std::vector<ChunkBounds> parts = chunks.bounds(40), cell_bounds = chunks.measured_bounds(1);
  TraceThread a, b;
  uint64_t strands = 0;
  for (uint64_t i = 0; i < 60; ++i) {
    const Ray ray = inner_ray(9, i);
    const std::vector<ChunkBounds>& bounds = i % 3 == 0 ? parts : cell_bounds;
    const Hit expected = oracle->closest(ray, a), cold = make(chunks, bounds)->closest(ray, b);
    ASSERT_EQ(cold.strand_id, expected.strand_id) << i;
    ASSERT_EQ(cold.distance, expected.distance) << i;
    ASSERT_EQ(make(chunks, bounds)->transmittance(ray, b), oracle->transmittance(ray, a)) << i;
    strands += expected.kind == HitKind::kStrand;
  }
  EXPECT_GT(strands, 15u);
}

// Rays inside the box of a chunk, between its strands or ending before them, let nothing grow.
TEST_F(ChunkAccelTest, RaysThatMeetNoSegmentCellLetNothingGrow) {
  TestChunks chunks;
  chunks.add_fur(ladder(2), 0);
  const std::vector<ChunkBounds> measured =
      chunks.measured_bounds(1, {.cell_segments = 1, .part_cells = 1024});
  ASSERT_EQ(measured[0].part_count(), 1u);
  std::vector<ChunkBounds> coarse = measured;
  coarse[0].cell_bounds = {};
  Ray between;
  between.origin = {3, -1, 0.5f};
  between.direction = {0, 1, 0};
  Ray before = along_z(3);
  before.origin.z = 0.5f;
  before.far = 0.4f;
  TraceThread thread;
  for (const Ray& ray : {between, before}) {
    const auto cell_bounds = make(chunks, measured), without = make(chunks, coarse);
    EXPECT_FALSE(cell_bounds->closest(ray, thread));
    EXPECT_EQ(cell_bounds->transmittance(ray, thread), 1.0f);
    EXPECT_EQ(cell_bounds->chunks().counts().expansions, 0);
    EXPECT_FALSE(without->closest(ray, thread));
    EXPECT_EQ(without->chunks().counts().expansions, 1);
  }
  before.far = 0.6f;
  const auto cell_bounds = make(chunks, measured);
  EXPECT_TRUE(cell_bounds->closest(before, thread));
  EXPECT_EQ(cell_bounds->transmittance(before, thread), 0.0f);
  EXPECT_EQ(cell_bounds->chunks().counts().expansions, 1);
}

}  // namespace
}  // namespace pelage
