// SPDX-License-Identifier: Apache-2.0
#include "procedurals/bounds/bounding.h"

#include <algorithm>
#include <fstream>
#include <stdexcept>
#include <string>

#include <gtest/gtest.h>

#include "base/progress.h"
#include "base/temporary_folder.h"
#include "geom/curve_bounds.h"
#include "procedurals/bounds/bounds_file.h"
#include "procedurals/bounds/segment_parts.h"
#include "tests/procedurals/bounds_checks.h"
#include "tests/procedurals/random_coats.h"
#include "tests/support/effort.h"

namespace pelage {
namespace {

class RandomBounds : public testing::TestWithParam<int> {
 protected:
  RandomCoat coat_{static_cast<uint64_t>(GetParam()),
                   {.motion_keys = 1 + GetParam() % 4, .push_out = GetParam() % 5 == 4}};
};
INSTANTIATE_TEST_SUITE_P(Coat, RandomBounds, testing::Range(0, kSanitized ? 6 : 16));

// Every point +- radius that a ray can meet lies in a box at the ray's time, for every strategy that promises
// it.
TEST_P(RandomBounds, HoldEveryPointAtEveryTimeOfTheShutter) {
  for (BoundingStrategy strategy : kHolding) {
    const std::vector<ChunkBounds> bounds = bounds_of(coat_.chunks, {strategy});
    for (size_t leaf = 0; leaf < coat_.leaves.size(); ++leaf) {
      const Strands strands = coat_.leaves[leaf]->generate();
      // Sides of cell bounds are handed out as floats, which resolve no more than this there.
      const float rounding = 0x1p-22f * bounds[leaf].whole().max.length();
      ASSERT_EQ(bounds[leaf].cell_bounds.count() > 0, strategy != BoundingStrategy::kConservative);
      ASSERT_EQ(bounds[leaf].keys, strategy == BoundingStrategy::kLinear ? 2 : 1);
      for (int step = 0; step <= 12; ++step) {
        const float time = static_cast<float>(step) / 12;
        size_t outside = 0;
        for_some_points(strands, time, 5, [&](const V3f& at, float radius) {
          const Box3f ball(at - V3f(radius), at + V3f(radius));
          bool inside = false;
          for (size_t p = 0; p < bounds[leaf].part_count() && !inside; ++p) {
            inside = contains(at_time(bounds[leaf], p, time), ball);
          }
          if (bounds[leaf].cell_bounds.count() > 0 && inside) {
            inside = false;
            for (size_t b = 0; b < bounds[leaf].cell_bounds.count() && !inside; ++b) {
              inside = contains(grown(bounds[leaf].cell_bounds.box(b, time), rounding), ball);
            }
          }
          outside += !inside;
        });
        ASSERT_EQ(outside, 0u) << "strategy " << static_cast<int>(strategy) << " at " << time;
      }
    }
  }
}

// A bound that does not know the shutter holds the hair during the whole interval of the frame.
TEST_P(RandomBounds, HoldTheWholeFrameWhereTheShutterIsNotKnown) {
  const auto pose = coat_.skin->pose(BoundSpan::kFrame);
  const auto exact = bounds_of(coat_.chunks, {BoundingStrategy::kExact});
  const auto conservative = bounds_of(coat_.chunks, {BoundingStrategy::kConservative});
  for (size_t leaf = 0; leaf < coat_.leaves.size(); ++leaf) {
    const Strands strands = coat_.groom->grow(leaf, pose->skin());
    EXPECT_TRUE(contains(conservative[leaf].whole(), exact[leaf].whole()));
    for (int step = 0; step <= 30; ++step) {
      for_some_points(strands, static_cast<float>(step) / 30, 11, [&](const V3f& at, float radius) {
        const Box3f ball(at - V3f(radius), at + V3f(radius));
        ASSERT_TRUE(contains(exact[leaf].whole(), ball));
      });
    }
  }
}

// Sampled densely, some point +- radius comes within 1e-4 of the diagonal of each face.
TEST_P(RandomBounds, ExactOnesTouch) {
  for (BoundingStrategy strategy : {BoundingStrategy::kExact, BoundingStrategy::kExactShutter}) {
    const auto pose = coat_.skin->pose(bound_span(strategy));
    const ChunkBounds bounds = bounds_of({coat_.chunks[0]}, {strategy})[0];
    const Strands strands = coat_.groom->grow(0, pose->skin());
    const SegmentParts parts(strands);
    ASSERT_EQ(bounds.part_count(), parts.part_count());
    for (size_t p = 0; p < parts.part_count(); ++p) {
      Box3f samples;
      for (const SegmentPlace place : parts.part(p)) {
        for (int key = 0; key < strands.motion_keys(); ++key) {
          const CubicSegment segment = bezier_segment(strands, place.strand, place.segment, key);
          for (int step = 0; step <= 48; ++step) {
            const float t = static_cast<float>(step) / 48;
            const V3f at = curve_position(segment, t), reach(curve_radius(segment, t));
            samples.extendBy(at - reach);
            samples.extendBy(at + reach);
          }
        }
      }
      const Box3f& box = bounds.box(p, 0);
      // Boxes are enlarged by what floats do not resolve at their distance from the origin.
      const float gap = std::max(1e-4f * box.size().length(), 0x1p-20f * (1 + box.center().length()));
      for (int axis = 0; axis < 3; ++axis) {
        EXPECT_LE(samples.min[axis] - box.min[axis], gap);
        EXPECT_LE(box.max[axis] - samples.max[axis], gap);
      }
      EXPECT_TRUE(contains(box, samples));
    }
  }
}

TEST_P(RandomBounds, NestAsTheirNamesSay) {
  const auto conservative = bounds_of(coat_.chunks, {BoundingStrategy::kConservative});
  const auto exact = bounds_of(coat_.chunks, {BoundingStrategy::kExact});
  const auto shutter = bounds_of(coat_.chunks, {BoundingStrategy::kExactShutter});
  const auto linear = bounds_of(coat_.chunks, {BoundingStrategy::kLinear});
  for (size_t leaf = 0; leaf < coat_.chunks.size(); ++leaf) {
    EXPECT_EQ(conservative[leaf].boxes.size(), 1u);
    EXPECT_TRUE(contains(conservative[leaf].whole(), exact[leaf].whole()));
    EXPECT_TRUE(contains(exact[leaf].whole(), shutter[leaf].whole()));
    if (coat_.skin->motion_keys() == 1) {
      EXPECT_EQ(exact[leaf].boxes, shutter[leaf].boxes);
    }
    if (coat_.skin->motion_keys() == 2) {  // nothing to pad for
      const Box3f box = shutter[leaf].whole();
      const V3f rounding(1e-6f * (1 + box.center().length()));
      EXPECT_TRUE(contains({box.min - rounding, box.max + rounding}, linear[leaf].whole()));
    }
  }
}

TEST_P(RandomBounds, AreTheSameForAnyNumberOfThreads) {
  for (BoundingStrategy strategy : kHolding) {
    EXPECT_TRUE(same(bounds_of(coat_.chunks, {strategy}, 1), bounds_of(coat_.chunks, {strategy}, 4)));
  }
}

TEST(Bounding, ConservativeOnesAreWithinASaneFactor) {
  RandomCoatOptions options{.motion_keys = 2, .strands = 4000, .leaf_strands = 500};
  options.operators = stacks::usual();
  const RandomCoat coat(1, options);
  double conservative = 0, exact = 0;
  for (const ChunkBounds& chunk : bounds_of(coat.chunks, {BoundingStrategy::kConservative}))
    conservative += surface_area(chunk.whole());
  for (const ChunkBounds& chunk : bounds_of(coat.chunks, {BoundingStrategy::kExact}))
    exact += surface_area(chunk.whole());
  RecordProperty("conservative_over_exact", std::to_string(conservative / exact));
  EXPECT_GT(conservative / exact, 1);
  EXPECT_LT(conservative / exact, 4);
}

TEST(Bounding, NoneAreNone) {
  const RandomCoat coat(2, {});
  for (const ChunkBounds& none : bounds_of(coat.chunks, {BoundingStrategy::kNone})) {
    EXPECT_TRUE(none.boxes.empty());
  }
}

TEST(Bounding, NoChunksHaveNoBoxes) {
  for (BoundingStrategy strategy : kHolding) EXPECT_TRUE(bounds_of({}, {strategy}).empty());
}

// Leaves that remember their boxes, and count how often they are grown for it.

TEST(Bounding, OfCachedCoatsAreRememberedBesideTheCache) {
  const TemporaryFolder folder;
  const auto expect = [&](uint64_t seed, float length, bool known) {
    const RandomCoat coat(seed, {.length = length, .cache = folder.path()});
    const auto all = static_cast<int64_t>(coat.chunks.size());
    BoundingCounts counts;
    const auto bounds = bounds_of(coat.chunks, {BoundingStrategy::kExact}, 2, expect_no_warning, &counts);
    EXPECT_EQ(counts.remembered, known ? all : 0);
    EXPECT_EQ(counts.measured, known ? 0 : all);
    for (size_t leaf = 0; leaf < coat.chunks.size(); ++leaf) {
      EXPECT_EQ(bounds[leaf].boxes, coat.chunks[leaf]->exact_bounds(BoundSpan::kFrame, 1).boxes);
    }
  };
  expect(5, 1, false);
  expect(5, 1, true);
  expect(5, 1.01f, false);  // another length
  expect(6, 1, false);      // another groom and pose
  expect(5, 1, true);
  expect(6, 1, true);
  EXPECT_FALSE(RandomCoat(5, {}).chunks[0]->bounds_record().has_value());
}

// The box of a coat is asked for before any leaf of it; animals of crowds have longer and shorter hair.
TEST(Bounding, OfWholeCoatsFollowTheLengthOfTheirHair) {
  for (uint64_t seed = 0; seed < 6; ++seed) {
    V3f before(0);
    for (const float length : {1.0f, 3.0f, 9.0f}) {
      const RandomCoat coat(seed, {.length = length});
      const FurProcedural fur(coat.groom, coat.skin);
      const Box3f whole = fur.bound(BoundSpan::kFrame);
      for (const ChunkBounds& leaf : bounds_of(coat.chunks, {BoundingStrategy::kExact}))
        EXPECT_TRUE(contains(whole, leaf.whole())) << length << " " << seed;
      for_some_points(fur.generate(), 0.5f, 7, [&](const V3f& position, float radius) {
        const V3f r(radius);
        EXPECT_TRUE(contains(fur.bound(BoundSpan::kShutter), {position - r, position + r}));
      });
      EXPECT_GT(whole.size().x, before.x);
      before = whole.size();
    }
  }
}

TEST(Bounding, PassesOnWhatGrowingThrows) {
  class Failing final : public Procedural {
   public:
    Box3f bound(BoundSpan) const override { return {V3f(0), V3f(1)}; }
    Strands generate() const override { throw std::runtime_error("bald"); }
    StrandCounts counts() const override { return {}; }
    StrandScale scale() const override { return {}; }
    ChunkBounds exact_bounds(BoundSpan, int) const override { throw std::runtime_error("bald"); }
  } failing;
  EXPECT_THROW(bounds_of({&failing}, {BoundingStrategy::kExact}), std::runtime_error);
}

TEST(Bounding, LeavesEarlyWhenCancelled) {
  class Cancelled final : public Progress {
   public:
    void begin(std::string_view, double) override {}
    void advance(double) override { ++done; }
    void end() override {}
    bool cancelled() const override { return true; }
    std::atomic<int> done{0};
  } progress;
  const RandomCoat coat(2, {});
  MemoryLedger ledger;
  const Workers workers(2);
  const auto bounds = bound_chunks({BoundingStrategy::kExact}, coat.chunks, {workers, ledger, progress});
  EXPECT_EQ(progress.done, 0);
  for (const ChunkBounds& chunk : bounds) EXPECT_TRUE(chunk.boxes.empty());
}

}  // namespace
}  // namespace pelage
