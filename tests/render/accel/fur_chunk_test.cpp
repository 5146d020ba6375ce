// SPDX-License-Identifier: Apache-2.0
#include "render/accel/fur_chunk.h"

#include <limits>
#include <map>

#include <gtest/gtest.h>

#include "geom/strand_merge.h"
#include "geom/strand_point.h"
#include "tests/render/accel/chunk_accel_fixture.h"
#include "tests/soak.h"
#include "tests/support/effort.h"

namespace pelage {
namespace {

/// The strands of all chunks of a part as one chunk, other chunks as they are.
TestChunks as_one(const TestChunks& chunks) {
  TestChunks one;
  std::map<uint32_t, std::vector<Strands>> batches;
  for (const ChunkContents& chunk : chunks.contents) {
    if (const auto* fur = std::get_if<FurContents>(&chunk.geometry)) {
      // Opacity goes along as an attribute, to be brought into the same order.
      StrandArrays a = Strands(fur->strands).release();
      std::vector<float> opacity = fur->opacity;
      if (opacity.empty()) opacity.assign(fur->strands.point_count(), 1.0f);
      a.attributes.push_back({"opacity", AttributeClass::kPerPoint, 1, std::move(opacity)});
      batches[chunk.part].push_back(Strands(std::move(a)));
    } else {
      one.contents.push_back(chunk);
    }
  }
  for (auto& [part, strands] : batches) {
    StrandArrays a = merge(strands).release();
    std::vector<float> opacity;
    for (size_t i = 0; i < a.attributes.size(); ++i) {
      if (a.attributes[i].name != "opacity") continue;
      opacity = a.attributes[i].values;
      a.attributes.erase(a.attributes.begin() + static_cast<std::ptrdiff_t>(i));
    }
    one.add_fur(Strands(std::move(a)), part, std::move(opacity));
  }
  return one;
}

ResidentChunksOptions fur_options() {
  ResidentChunksOptions options;
  options.kind = AccelKind::kFur;
  return options;
}

class FurChunkScenes : public ChunkAccelTest, public testing::WithParamInterface<int> {};

TEST_P(FurChunkScenes, AnyChunksAnswerAsOneTreePerCoat) {
  const TestChunks chunks = random_chunks(7, scene_of_kind(GetParam()));
  const TestChunks merged = as_one(chunks);
  ResidentChunksOptions eager = fur_options();
  eager.eager = true;
  const auto whole = make(merged, std::vector<ChunkBounds>(merged.contents.size()), eager);
  const uint64_t more = soak_scale();
  expect_same(*whole, *make(chunks, chunks.bounds(8), fur_options()), 1,
              repetitions(2500) * more);  // boxes of parts
  expect_same(*whole, *make(chunks, chunks.bounds(1, 1.4f), fur_options()), 2,
              repetitions(2500) * more);  // loose ones
  for (int keys : {1, 2})
    expect_same(*whole, *make(chunks, chunks.measured_bounds(keys), fur_options()), 4,
                repetitions(1500) * more);
  ResidentChunksOptions turned = fur_options();
  turned.fur.tree.build.rotation = FurRotation::kAlways;
  expect_same(*whole, *make(chunks, chunks.bounds(8), turned), 5, repetitions(2500) * more);
  turned.eager = true;
  expect_same(*whole, *make(chunks, std::vector<ChunkBounds>(chunks.contents.size()), turned), 6,
              repetitions(1500) * more);
  eager.fur.tree.build.node_cost = 3;
  expect_same(*whole, *make(chunks, std::vector<ChunkBounds>(chunks.contents.size()), eager), 3,
              repetitions(2500) * more);
}

INSTANTIATE_TEST_SUITE_P(All, FurChunkScenes, testing::Range(0, kSceneKinds));

class FurChunkTest : public ChunkAccelTest {};

TEST_F(FurChunkTest, BudgetsChangeNoAnswer) {
  RandomChunkOptions o;
  o.chunks = 40;
  o.strands = 40;
  o.translucent = true;
  const TestChunks chunks = random_chunks(17, o);
  ResidentChunksOptions four = fur_options();
  four.threads = 4;
  const auto whole = make(chunks, chunks.bounds(8), four);
  int64_t working_set = 0, fixed = 0;
  size_t largest = 0;
  {
    const int64_t before = ledger_.budgeted();
    const auto accel = make(chunks, chunks.bounds(8), fur_options());
    fixed = ledger_.budgeted() - before;
    expect_same(*whole, *accel, 1, repetitions(2000));
    working_set = accel->chunks().counts().working_set_bytes;
    EXPECT_EQ(accel->chunks().counts().overruns, 0);
    for (uint32_t c = 0; c < chunks.contents.size(); ++c) {
      const ChunkCounts n = chunks.counts(c);
      largest = std::max(largest,
                         std::max(FurChunk::bytes_bound(n, FurChunkOptions()), EmbreeChunk::bytes_bound(n)) +
                             part_bounds_scratch(n));
    }
  }
  for (int threads : {1, 4}) {
    for (int percent : {50, 10}) {
      if (kSanitized && (threads == 1) == (percent == 10)) continue;
      ResidentChunksOptions options = fur_options();
      options.threads = threads;
      options.memory_limit = static_cast<uint64_t>(
          ledger_.budgeted() + fixed + 16384 +
          std::max(working_set * percent / 100, threads * static_cast<int64_t>(largest)));
      const auto accel = make(chunks, chunks.measured_bounds(percent == 10 ? 2 : 1), options);
      Workers(threads).for_each(
          4, 1, [&](WorkRange range) { expect_same(*whole, *accel, 100 + range.begin, 20, range.worker); });
      EXPECT_EQ(accel->chunks().counts().overruns, 0);
      EXPECT_GT(accel->chunks().counts().evictions, 0);
    }
  }
}

TEST_F(FurChunkTest, EqualDistancesAreDecidedByStrandIdAcrossChunks) {
  for (int order = 0; order < 4; ++order) {
    TestChunks chunks;
    if (order & 2) chunks.add_skin(quad(0), 0);  // at the depth of the first strand
    chunks.add_fur(ladder(2, order & 1 ? 8 : 3), 0);
    chunks.add_fur(ladder(2, order & 1 ? 3 : 8), 0);
    if (!(order & 2)) chunks.add_skin(quad(0), 0);
    const auto accel = make(chunks, chunks.bounds(4), fur_options());
    TraceThread thread;
    for (float x = 0.1f; x < 6.9f; x += 0.05f) {
      const Hit hit = accel->closest(along_z(x), thread);
      ASSERT_EQ(hit.kind, HitKind::kStrand) << x;
      EXPECT_EQ(hit.strand_id, 3u) << x;
      EXPECT_EQ(thread.hit_geometry.strand.id(0), 3u);
    }
  }
}

// What is handed to shading are the curves that were hit: those of the strand, to within half a step of the
// grid.
TEST_F(FurChunkTest, HandsOutTheStrandThatWasHit) {
  for (int kind = 0; kind < kSceneKinds; ++kind) {
    const TestChunks chunks = random_chunks(3, scene_of_kind(kind));
    const auto accel = make(chunks, chunks.bounds(8), fur_options());
    const FurGrid grid(chunks.scale(0).width, chunks.scale(0).anchor);
    const FlushDenormals flush;
    TraceThread thread;
    int hits = 0;
    for (uint64_t i = 0; i < 400; ++i) {
      const Ray ray = random_ray(8, i);
      const Hit hit = accel->closest(ray, thread);
      if (hit.kind != HitKind::kStrand) continue;
      const Strands& strand_of_hit = thread.hit_geometry.strand;
      ASSERT_EQ(strand_of_hit.id(0), hit.strand_id);
      // The ray passes the axis at h radii.
      const StrandPoint at = strand_point(strand_of_hit, 0, hit.segment, hit.u, ray.time);
      const V3f beside = ray.origin + hit.distance * ray.direction - at.position;
      EXPECT_NEAR(beside.length(), std::abs(hit.v) * at.radius, 1e-4f + 0.02f * at.radius);
      // Among the strands of its id, one is the same.
      double nearest = 1e30;
      for (const ChunkContents& chunk : chunks.contents) {
        const auto* fur = std::get_if<FurContents>(&chunk.geometry);
        if (!fur || chunk.part != hit.part) continue;
        for (size_t s = 0; s < fur->strands.strand_count(); ++s) {
          const uint32_t segments = segment_count(fur->strands.basis(), fur->strands.strand_points(s));
          if (fur->strands.id(s) != hit.strand_id ||
              segments != segment_count(strand_of_hit.basis(), strand_of_hit.strand_points(0)))
            continue;
          double off = 0;
          for (uint32_t k = 0; k < segments; ++k) {
            for (float time : {0.0f, 0.4f, 1.0f}) {
              const CubicSegment a = bezier_segment_at(fur->strands, s, k, time),
                                 b = bezier_segment_at(strand_of_hit, 0, k, time);
              for (size_t p = 0; p < 4; ++p) {
                // Inner points are the ends plus two snapped differences.
                const V3f d = (p == 0 || p == 3 ? 1.0f : 0.5f) * (a.p[p] - b.p[p]);
                off = std::max({off, std::abs(double(d.x)), std::abs(double(d.y)), std::abs(double(d.z))});
              }
            }
          }
          nearest = std::min(nearest, off);
        }
      }
      EXPECT_LE(nearest, 0.51 * grid.step() + 1e-6);
      ++hits;
    }
    EXPECT_GT(hits, 50);
  }
}

// No ray meets segments whose points are not finite, and nothing that draws strands draws them elsewhere.
TEST_F(FurChunkTest, StrandsBeginWhereTheyAreDrawn) {
  const auto chunk_of = [](StrandArrays arrays) {
    TestChunks chunks;
    chunks.add_fur(Strands(std::move(arrays)), 0);
    return FurChunk(chunks.grow(0), 0, FurGrid(0.1f, V3f(1, 2, 3)), {});
  };
  const StrandArrays sound = ladder(1).release();  // of seven segments
  const FurChunk whole = chunk_of(sound);
  Strands expected, strand;
  whole.strand(0, expected);
  for (const size_t broken : {size_t(1), size_t(2), size_t(8)}) {
    StrandArrays arrays = sound;
    for (size_t i = 0; i < broken; ++i) arrays.points[4 * i] = std::numeric_limits<float>::quiet_NaN();
    chunk_of(std::move(arrays)).strand(0, strand);
    ASSERT_EQ(strand.point_count(), expected.point_count());
    const size_t lost = std::min<size_t>(3 * (broken + 1), 21);  // in one segment more than points
    for (size_t p = 0; p < strand.point_count(); ++p) {
      const bool drawn = broken < 8 && p >= lost;
      const V3f at = broken == 8 ? V3f(1, 2, 3) : expected.point(drawn ? p : lost);
      EXPECT_EQ(strand.point(p), at) << broken << " " << p;
    }
    EXPECT_EQ(strand.radius(5) == 0, broken == 8);
  }
}

TEST_F(FurChunkTest, ReservationsHold) {
  for (CurveBasis basis :
       {CurveBasis::kPinnedBSpline, CurveBasis::kCatmullRom, CurveBasis::kLinear, CurveBasis::kBSpline}) {
    for (int keys = 1; keys <= 4; keys += kSanitized ? 3 : 1) {
      for (size_t strands : {1, 2, 3, 9, 60, 500, 1171}) {
        for (float wander : {0.01f, 0.1f, 30.0f}) {  // the last needs wide leaves
          SCOPED_TRACE(testing::Message()
                       << static_cast<int>(basis) << " " << keys << " " << strands << " " << wander);
          RandomStrandOptions o;
          o.basis = basis;
          o.motion_keys = keys;
          o.strands = strands;
          o.min_points = strands % 2 == 0 ? 4 : 8;
          o.max_points = 8;
          o.wander = wander;
          TestChunks chunks;
          chunks.add_fur(random_strands(strands, o), 0);
          const FurChunk chunk(chunks.grow(0), 0, FurGrid(0.02f), {});
          const size_t bound = FurChunk::bytes_bound(chunks.counts(0), FurChunkOptions());
          const size_t while_built = chunk.build_peak_bytes();
          EXPECT_LE(chunk.bytes(), while_built);
          EXPECT_LE(while_built, bound);
          EXPECT_LE(FurChunk::bytes_bound(chunks.counts(0), while_built), bound);
          EXPECT_LE(bound, 3 * while_built + 8 * 1024);
        }
      }
    }
  }
}

TEST_F(FurChunkTest, HoldsFewBytesPerStrand) {
  RandomStrandOptions o;
  o.strands = 2000;
  o.min_points = o.max_points = 8;
  o.radius = 0.002f;
  TestChunks chunks;
  chunks.add_fur(random_strands(5, o), 0);
  const FurChunk chunk(chunks.grow(0), 0, FurGrid(0.004f), {});
  EXPECT_LT(chunk.bytes(), 340 * o.strands);
}

}  // namespace
}  // namespace pelage
