// SPDX-License-Identifier: Apache-2.0
#include "render/accel/resident_chunks.h"

#include <algorithm>
#include <numeric>

#include <gtest/gtest.h>

#include "geom/curve.h"
#include "tests/render/accel/chunk_accel_fixture.h"
#include "tests/support/effort.h"

namespace pelage {
namespace {

ResidentChunksOptions options_of(AccelKind kind) {
  ResidentChunksOptions options;
  options.kind = kind;
  return options;
}

/// The strands of a batch that have a segment, in the order of a chunk.
std::vector<uint32_t> in_order(const Strands& strands, AccelKind kind) {
  std::vector<uint32_t> order(strands.strand_count());
  std::iota(order.begin(), order.end(), 0u);
  std::erase_if(order,
                [&](uint32_t s) { return segment_count(strands.basis(), strands.strand_points(s)) == 0; });
  if (kind == AccelKind::kFur) {
    std::stable_sort(order.begin(), order.end(),
                     [&](uint32_t a, uint32_t b) { return strands.id(a) < strands.id(b); });
  }
  return order;
}

/// The farthest that a Bezier point of `b` is from that of `a`, along an axis; inner points count half.
float distance_of_curves(const Strands& a, const Strands& b) {
  float off = 0;
  const uint32_t segments = segment_count(a.basis(), a.strand_points(0));
  if (segments != segment_count(b.basis(), b.strand_points(0))) return 1e9f;
  for (uint32_t s = 0; s < segments; ++s) {
    for (int key = 0; key < a.motion_keys(); ++key) {
      const CubicSegment x = bezier_segment(a, 0, s, key), y = bezier_segment(b, 0, s, key);
      for (size_t p = 0; p < 4; ++p) {
        const V3f d = (p == 0 || p == 3 ? 1.0f : 0.5f) * (x.p[p] - y.p[p]);
        off = std::max({off, std::abs(d.x), std::abs(d.y), std::abs(d.z)});
      }
    }
  }
  return off;
}

class ResidentChunksScenes : public ChunkAccelTest, public testing::WithParamInterface<int> {};

// Strand by strand what was grown: bit by bit for Embree, on the grid of the coat for fur trees.
TEST_P(ResidentChunksScenes, GiveTheStrandsThatWereGrown) {
  const TestChunks chunks = random_chunks(3, scene_of_kind(GetParam()));
  const FlushDenormals flush;
  for (const AccelKind kind : kAccelKinds) {
    const auto held = hold(chunks, chunks.bounds(8), options_of(kind));
    for (uint32_t chunk = 0; chunk < held->size(); ++chunk) {
      const auto* fur = std::get_if<FurContents>(&chunks.contents[chunk].geometry);
      ASSERT_EQ(held->is_skin(chunk), fur == nullptr);
      if (!fur) {
        EXPECT_EQ(strand_count(*held, chunk), 0u);
        continue;
      }
      const std::vector<uint32_t> order = in_order(fur->strands, kind);
      ASSERT_EQ(strand_count(*held, chunk), order.size());
      Strands grown, strand;
      for (uint32_t index = 0; index < order.size(); ++index) {
        grown.assign_strand(fur->strands, order[index]);
        held->copy_strand({chunk, index}, 0, strand);
        if (kind == AccelKind::kEmbree) {
          ASSERT_TRUE(are_equal(strand, grown)) << chunk << " " << index;
          continue;
        }
        ASSERT_EQ(strand.basis(), CurveBasis::kBezier);
        ASSERT_EQ(strand.id(0), grown.id(0));
        ASSERT_EQ(strand.find_attribute("color")->values, grown.find_attribute("color")->values);
        ASSERT_LE(distance_of_curves(grown, strand), 0.51f * FurGrid(chunks.scale(chunk)).step() + 1e-6f);
      }
    }
  }
}

// A hit says where its strand is found again, and what it is called.
TEST_P(ResidentChunksScenes, HitsNameTheirStrands) {
  const TestChunks chunks = random_chunks(7, scene_of_kind(GetParam()));
  const FlushDenormals flush;
  for (const AccelKind kind : kAccelKinds) {
    const auto accel = make(chunks, chunks.bounds(8), options_of(kind));
    TraceThread thread;
    Strands strand;
    int strands = 0, skins = 0;
    for (uint64_t i = 0; i < 600; ++i) {
      const Hit hit = accel->closest(random_ray(8, i), thread);
      const StrandHandle handle = hit.handle();
      EXPECT_EQ(static_cast<bool>(handle), hit.kind == HitKind::kStrand);
      skins += hit.kind == HitKind::kSkin;
      if (!handle) continue;
      accel->chunks().copy_strand(handle, 0, strand);
      ASSERT_TRUE(are_equal(strand, thread.hit_geometry.strand)) << i;
      EXPECT_EQ(accel->chunks().part(handle.chunk), hit.part);
      const StrandKey key = accel->chunks().visit(
          handle.chunk, 0, [&](const ChunkGeometry& chunk) { return chunk.strand_key(handle.index); });
      EXPECT_EQ(key, hit.key());
      EXPECT_EQ(key, (StrandKey{hit.part, hit.strand_id}));
      const StrandStart start = accel->chunks().visit(handle.chunk, 0, [&](const ChunkGeometry& chunk) {
        return chunk.start_on(handle.index, hit.start.place);
      });
      EXPECT_EQ(start.chunk, hit.start.chunk);
      EXPECT_EQ(start.first_segment, hit.start.first_segment);
      EXPECT_EQ(start.segment_count, hit.start.segment_count);
      EXPECT_EQ(start.place, hit.start.place);
      ++strands;
    }
    EXPECT_GT(strands, 100);
    EXPECT_GT(skins, 10);
  }
  // One scene over everything has no chunks.
  TraceThread thread;
  const auto whole = chunks.oracle(CurveShape::kFlat);
  for (uint64_t i = 0; i < 50; ++i) EXPECT_FALSE(whole->closest(random_ray(8, i), thread).handle());
}

INSTANTIATE_TEST_SUITE_P(All, ResidentChunksScenes, testing::Range(0, kSceneKinds));

class ResidentChunksTest : public ChunkAccelTest {
 protected:
  /// Enough for a few of many small chunks.
  ResidentChunksOptions limited(const TestChunks& chunks, AccelKind kind, int threads) {
    ResidentChunksOptions options = options_of(kind);
    options.threads = threads;
    size_t largest = 0;
    for (uint32_t c = 0; c < chunks.contents.size(); ++c) {
      const ChunkCounts n = chunks.counts(c);
      largest = std::max({largest, FurChunk::bytes_bound(n, FurChunkOptions()),
                          EmbreeChunk::bytes_bound(n) + part_bounds_scratch(n)});
    }
    const auto idle = hold(chunks, chunks.bounds(8), options);
    options.memory_limit =
        static_cast<uint64_t>(ledger_.budgeted() + 16384) + static_cast<size_t>(threads) * largest;
    return options;
  }
};

// The same strand for any budget and any number of threads, after its chunk was dropped and grown again.
TEST_F(ResidentChunksTest, HandlesNameTheSameStrandForAnyBudget) {
  RandomChunkOptions o;
  o.chunks = 120;
  o.strands = 40;
  o.motion_keys = 2;
  o.uniform = false;
  o.translucent = true;
  const TestChunks chunks = random_chunks(17, o);
  for (const AccelKind kind : kAccelKinds) {
    std::vector<std::pair<StrandHandle, Strands>> strands;
    {
      const auto all = hold(chunks, chunks.bounds(8), options_of(kind));
      ResidentChunksOptions eager = options_of(kind);
      eager.eager = true;
      expect_same_strands(*all, *hold(chunks, std::vector<ChunkBounds>(all->size()), eager));
      for (uint32_t chunk = 0; chunk < all->size(); ++chunk) {
        for (uint32_t index = 0; index < strand_count(*all, chunk); ++index) {
          strands.emplace_back(StrandHandle{chunk, index}, Strands());
          all->copy_strand(strands.back().first, 0, strands.back().second);
        }
      }
    }
    for (const int threads : {1, 4}) {
      const auto few = hold(chunks, chunks.bounds(8), limited(chunks, kind, threads));
      Workers(threads).for_each(8, 1, [&](WorkRange range) {
        const FlushDenormals flush;
        Strands strand;
        for (uint64_t i = 0; i < repetitions(150); ++i) {
          const auto& [handle, expected] = strands[hash64(range.begin, i) % strands.size()];
          few->copy_strand(handle, range.worker, strand);
          ASSERT_TRUE(are_equal(strand, expected)) << handle.chunk << " " << handle.index;
        }
      });
      EXPECT_GT(few->counts().evictions, 10);
      EXPECT_GT(few->counts().reexpansions, 10);
      EXPECT_EQ(few->counts().overruns, 0);
    }
  }
}

TEST_F(ResidentChunksTest, VisitsAndRaysShareTheBudget) {
  RandomChunkOptions o;
  o.chunks = 40;
  o.strands = 40;
  const TestChunks chunks = random_chunks(17, o);
  ResidentChunksOptions eager = options_of(AccelKind::kFur);
  eager.eager = true;  // so that what it holds is no part of the limit
  const auto roomy = make(chunks, std::vector<ChunkBounds>(chunks.contents.size()), eager);
  ResidentChunksOptions options = limited(chunks, AccelKind::kFur, 2);
  options.memory_limit += 4 * 2 * chunks.contents.size();  // what rays need of each chunk
  const auto accel = make(chunks, chunks.bounds(8), options);
  Workers(2).for_each(2, 1, [&](WorkRange range) {
    if (range.begin == 0) {
      expect_same(*roomy, *accel, 3, at_least(16, 60), 0);
      return;
    }
    Strands strand;
    for (uint32_t i = 0; i < at_least(80, 300); ++i) {
      const StrandHandle handle{i % 40, i % 7};
      accel->chunks().copy_strand(handle, 1, strand);
      ASSERT_EQ(strand.strand_count(), 1u);
    }
  });
  EXPECT_GT(accel->chunks().counts().evictions, 0);
  EXPECT_LE(ledger_.budgeted(), static_cast<int64_t>(options.memory_limit));
}

TEST_F(ResidentChunksTest, ErrorsOfTheGrowerReachWhoVisits) {
  TestChunks chunks;
  for (uint64_t i = 0; i < 2; ++i) chunks.add_fur(ladder(2, 10 * i), 0);
  chunks.fails_at = 1;
  const auto held = hold(chunks, chunks.bounds(4));
  EXPECT_EQ(strand_count(*held, 0), 2u);
  EXPECT_THROW(strand_count(*held, 1), std::runtime_error);
  EXPECT_THROW(strand_count(*held, 1), std::runtime_error);
  EXPECT_EQ(strand_count(*held, 0), 2u);
}

// A worker holds one chunk at a time: with a budget a second one could wait for ever, so that it is a bug
// without one, too.
using ResidentChunksDeathTest = ResidentChunksTest;
TEST_F(ResidentChunksDeathTest, VisitsWithinAVisitAreABug) {
  GTEST_FLAG_SET(death_test_style, "threadsafe");
  TestChunks chunks;
  for (uint64_t i = 0; i < 2; ++i) chunks.add_fur(ladder(2, 10 * i), 0);
  for (const uint64_t limit : {uint64_t(0), uint64_t(1) << 30}) {
    ResidentChunksOptions options = options_of(AccelKind::kFur);
    options.memory_limit = limit;
    const auto accel = make(chunks, chunks.bounds(4), options);
    const ResidentChunks& held = accel->chunks();
    Strands strand;
    TraceThread thread;
    EXPECT_DEATH(held.visit(0, 0,
                            [&](const ChunkGeometry&) {
                              held.copy_strand({1, 0}, 0, strand);
                            }),
                 "hazard");
    EXPECT_DEATH(held.visit(0, 0, [&](const ChunkGeometry&) { accel->closest(along_z(3), thread); }),
                 "hazard");
    held.copy_strand({1, 0}, 0, strand);
    EXPECT_EQ(strand.id(0), 10u);
  }
}

/// Chunks with the numbers reversed that must not grow.
TestChunks reversed(const TestChunks& chunks) {
  TestChunks other = chunks;
  std::reverse(other.contents.begin(), other.contents.end());
  return other;
}

// An accelerator with the chunks of an earlier one, under other numbers, answers every ray as a new one does.
TEST_F(ResidentChunksScenes, KeptChunksServeAnotherFrame) {
  for (const bool moving : {false, true}) {
    RandomChunkOptions scene;
    scene.translucent = true;
    scene.skins = false;
    scene.motion_keys = moving ? 2 : 1;
    const TestChunks first = random_chunks(8, scene), second = reversed(first);
    const auto count = static_cast<uint32_t>(first.contents.size());
    ResidentChunksOptions options = options_of(AccelKind::kFur);
    options.pool = std::make_shared<PagePool>();
    const int64_t before = ledger_.budgeted();
    auto old = make(first, first.measured_bounds(1), options);
    for (uint32_t chunk = 0; chunk < count; chunk += 2) strand_count(old->chunks(), chunk);
    std::vector<ChunkBounds> bounds(count);
    std::vector<KeptChunk> kept(count);
    for (uint32_t chunk = 0; chunk < count; ++chunk) {
      KeptChunk& moved = kept[count - 1 - chunk] = old->chunks().release(chunk, ledger_);
      EXPECT_EQ(moved.fur != nullptr, chunk % 2 == 0);
      ASSERT_EQ(moved.bounds.boxes.size(), 1u);
      bounds[count - 1 - chunk] = moved.bounds;
    }
    old = nullptr;
    EXPECT_GT(ledger_.budgeted(), before) << "kept chunks are charged";

    const auto truth = make(second, second.measured_bounds(1), options_of(AccelKind::kFur));
    const auto accel = std::make_unique<ChunkAccel>(std::move(bounds), second, options,
                                                    Job{workers_, ledger_, progress_}, std::move(kept));
    for (uint32_t chunk = 0; chunk < count; ++chunk) {
      EXPECT_EQ(accel->chunks().is_resident(count - 1 - chunk), chunk % 2 == 0);
      EXPECT_EQ(accel->chunks().boxes().whole(chunk).min, truth->chunks().boxes().whole(chunk).min);
      EXPECT_EQ(accel->chunks().boxes().whole(chunk).max, truth->chunks().boxes().whole(chunk).max);
    }
    expect_same(*accel, *truth, 3, repetitions(2000));
    expect_same_strands(accel->chunks(), truth->chunks());
    EXPECT_EQ(accel->chunks().counts().expansions, count / 2) << "only the others grew";
  }
  EXPECT_EQ(ledger_.budgeted(), 0) << "everything is freed";
}

// Measured boxes change no hit, and save visits.
TEST_F(ResidentChunksScenes, TightenTheirBoxesWhenChunksHaveGrown) {
  for (const bool moving : {false, true}) {
    RandomChunkOptions scene;
    scene.motion_keys = moving ? 2 : 1;
    const TestChunks chunks = random_chunks(10, scene);
    std::vector<ChunkBounds> loose = chunks.bounds(1, 3);
    for (ChunkBounds& bounds : loose) bounds = {1, {bounds.whole()}, {}};
    const auto truth = make(chunks, chunks.measured_bounds(1), options_of(AccelKind::kFur));
    const auto accel = make(chunks, loose, options_of(AccelKind::kFur));
    const auto visits = [&] {
      const FlushDenormals flush;
      TraceThread thread;
      for (uint64_t i = 0; i < 500; ++i) accel->closest(random_ray(4, i), thread);
      return thread.counts.chunk_visits;
    };
    const Job job{workers_, ledger_, progress_};
    strand_count(accel->chunks(), 0);
    accel->chunks().tighten(job);  // one chunk has grown
    expect_same(*accel, *truth, 4, repetitions(1000));
    const int64_t before = visits(), memory = ledger_.budgeted();
    accel->chunks().tighten(job);
    EXPECT_LT(visits(), before);
    EXPECT_NEAR(static_cast<double>(ledger_.budgeted()), static_cast<double>(memory), 1000);
    expect_same(*accel, *truth, 5, repetitions(1000));
    const KeptChunk kept = accel->chunks().release(0, ledger_);
    EXPECT_LT(kept.bounds.whole().size().x, loose[0].whole().size().x / 2);
  }
}

TEST_F(ResidentChunksScenes, KeptChunksRespectTheLimitAndTheWidthsOfTheNewFrame) {
  RandomChunkOptions scene;
  scene.skins = false;
  const TestChunks chunks = random_chunks(9, scene);
  const auto count = static_cast<uint32_t>(chunks.contents.size());
  ResidentChunksOptions options = options_of(AccelKind::kFur);
  options.pool = std::make_shared<PagePool>();
  const auto keep = [&] {
    auto old = make(chunks, chunks.measured_bounds(1), options);
    std::vector<KeptChunk> kept;
    for (uint32_t chunk = 0; chunk < count; ++chunk) {
      strand_count(old->chunks(), chunk);
      kept.push_back(old->chunks().release(chunk, ledger_));
    }
    return kept;
  };
  std::vector<KeptChunk> kept = keep();
  const size_t narrow = kept[0].fur->bytes();
  options.fur.min_width = MinWidth{{}, 1.0f};
  {
    const ResidentChunks held(chunks.measured_bounds(1), chunks, options, Job{workers_, ledger_, progress_},
                              std::move(kept));
    EXPECT_GT(held.visit(0, 0, [](const ChunkGeometry& chunk) { return chunk.bytes(); }), narrow);
    EXPECT_EQ(held.counts().expansions, 0);
  }
  kept = keep();
  options.fur.min_width = {};
  EXPECT_GT(kept[0].fur->bytes(), narrow) << "widened strands";
  // The index of the chunks needs memory too, so they do not all fit.
  options.memory_limit = static_cast<uint64_t>(ledger_.budgeted());
  ledger_.set_limit(options.memory_limit);
  const ResidentChunks held(chunks.measured_bounds(1), chunks, options, Job{workers_, ledger_, progress_},
                            std::move(kept));
  EXPECT_LE(ledger_.budgeted(), static_cast<int64_t>(options.memory_limit));
  uint32_t resident = 0;
  for (uint32_t chunk = 0; chunk < count; ++chunk) {
    resident += held.is_resident(chunk);
    EXPECT_GT(strand_count(held, chunk), 0u);
    EXPECT_LE(ledger_.budgeted(), static_cast<int64_t>(options.memory_limit));
  }
  EXPECT_GT(resident, 0u);
  EXPECT_LT(resident, count);
}

}  // namespace
}  // namespace pelage
