// SPDX-License-Identifier: Apache-2.0
#include "procedurals/bounding.h"

#include <algorithm>
#include <fstream>
#include <stdexcept>
#include <string>

#include <gtest/gtest.h>

#include "base/progress.h"
#include "base/temporary_folder.h"
#include "geom/curve_bounds.h"
#include "procedurals/bounds_file.h"
#include "procedurals/segment_parts.h"
#include "tests/procedurals/random_coats.h"

namespace pelage {
namespace {

constexpr BoundingStrategy kHolding[] = {BoundingStrategy::kConservative, BoundingStrategy::kExact,
                                         BoundingStrategy::kExactShutter, BoundingStrategy::kLinear};

class WarningReceiver final : public Progress {
 public:
  explicit WarningReceiver(WarningSink receive) : receive_(std::move(receive)) {}
  void begin(std::string_view, double) override {}
  void advance(double) override {}
  void end() override {}
  void warn(std::string_view line) override { receive_(std::string(line)); }
  bool cancelled() const override { return false; }

 private:
  WarningSink receive_;
};

void expect_no_warning(const std::string& line) { ADD_FAILURE() << line; }

std::vector<ChunkBounds> bounds_of(const std::vector<const Procedural*>& chunks,
                                   const BoundingOptions& options, int threads = 2,
                                   const WarningSink& warn = expect_no_warning,
                                   BoundingCounts* counts = nullptr) {
  MemoryLedger ledger;
  const Workers workers(threads);
  WarningReceiver progress(warn);
  const std::vector<ChunkBounds> bounds = bound_chunks(options, chunks, {workers, ledger, progress}, counts);
  EXPECT_EQ(ledger.budgeted(), 0);
  EXPECT_EQ(bounds.size(), chunks.size());
  return bounds;
}

Box3f at_time(const ChunkBounds& bounds, size_t part, float time) {
  if (bounds.keys == 1) return bounds.box(part, 0);
  const Box3f &a = bounds.box(part, 0), &b = bounds.box(part, 1);
  return {(1 - time) * a.min + time * b.min, (1 - time) * a.max + time * b.max};
}

bool contains(const Box3f& outer, const Box3f& inner) {
  return inner.isEmpty() || (outer.intersects(inner.min) && outer.intersects(inner.max));
}

Box3f grown(const Box3f& box, float by) { return {box.min - V3f(by), box.max + V3f(by)}; }

float surface_area(const Box3f& box) {
  const V3f d = box.size();
  return 2 * (d.x * d.y + d.y * d.z + d.z * d.x);
}

bool same(const FineBoxes& a, const FineBoxes& b) {
  if (a.count() != b.count() || a.levels() != b.levels()) return false;
  const FineBoxes::Grid &x = a.grid(), &y = b.grid();
  if (x.corner != y.corner || x.motion != y.motion || x.step != y.step) return false;
  return a.count() == 0 || std::equal(a.level(0).begin(), a.level(0).end(), b.level(0).begin());
}

bool same(const std::vector<ChunkBounds>& a, const std::vector<ChunkBounds>& b) {
  return std::equal(a.begin(), a.end(), b.begin(), b.end(), [](const ChunkBounds& x, const ChunkBounds& y) {
    return x.keys == y.keys && x.boxes == y.boxes && same(x.fine, y.fine);
  });
}

/// Calls check(position, radius) for points on some segments of some strands at a time.
template <class Check>
void for_some_points(const Strands& strands, float time, size_t step, const Check& check) {
  for (size_t strand = 0; strand < strands.strand_count(); strand += step) {
    for (uint32_t s = 0; s < segment_count(strands.basis(), strands.strand_points(strand)); ++s) {
      const CubicSegment segment = bezier_segment_at(strands, strand, s, time);
      for (float t : {0.0f, 0.35f, 0.7f, 1.0f}) check(curve_position(segment, t), curve_radius(segment, t));
    }
  }
}

class RandomBounds : public testing::TestWithParam<int> {
 protected:
  RandomCoat coat_{static_cast<uint64_t>(GetParam()),
                   {.motion_keys = 1 + GetParam() % 4, .push_out = GetParam() % 5 == 4}};
};
INSTANTIATE_TEST_SUITE_P(Coat, RandomBounds, testing::Range(0, 16));

// Every point +- radius that a ray can meet lies in a box at the ray's time, for every strategy that promises
// it.
TEST_P(RandomBounds, HoldEveryPointAtEveryTimeOfTheShutter) {
  for (BoundingStrategy strategy : kHolding) {
    const std::vector<ChunkBounds> bounds = bounds_of(coat_.chunks, {strategy});
    for (size_t leaf = 0; leaf < coat_.leaves.size(); ++leaf) {
      const Strands strands = coat_.leaves[leaf]->generate();
      // Sides of fine boxes are handed out as floats, which resolve no more than this there.
      const float rounding = 0x1p-22f * bounds[leaf].whole().max.length();
      ASSERT_EQ(bounds[leaf].fine.count() > 0, strategy != BoundingStrategy::kConservative);
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
          if (bounds[leaf].fine.count() > 0 && inside) {
            inside = false;
            for (size_t b = 0; b < bounds[leaf].fine.count() && !inside; ++b) {
              inside = contains(grown(bounds[leaf].fine.box(b, time), rounding), ball);
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

TEST(Bounding, UserOnesAreScaledAboutTheirCentresAndNoneAreNone) {
  const RandomCoat coat(2, {});
  const auto conservative = bounds_of(coat.chunks, {BoundingStrategy::kConservative});
  for (const ChunkBounds& none : bounds_of(coat.chunks, {BoundingStrategy::kNone})) {
    EXPECT_TRUE(none.boxes.empty());
  }
  for (float factor : {0.5f, 1.0f, 2.0f}) {
    const auto user = bounds_of(coat.chunks, {BoundingStrategy::kUser, factor});
    for (size_t leaf = 0; leaf < coat.chunks.size(); ++leaf) {
      const Box3f &a = conservative[leaf].boxes[0], &b = user[leaf].boxes[0];
      EXPECT_LT((a.center() - b.center()).length(), 1e-4f);
      EXPECT_LT((factor * a.size() - b.size()).length(), 1e-4f);
    }
  }
}

TEST(Bounding, NoChunksHaveNoBoxes) {
  for (BoundingStrategy strategy : kHolding) EXPECT_TRUE(bounds_of({}, {strategy}).empty());
}

// Leaves that remember their boxes, and count how often they are grown for it.
class Remembering final : public Procedural {
 public:
  Remembering(const Procedural& inner, BoundsRecord record) : inner_(inner), record_(std::move(record)) {}
  Box3f bound(BoundSpan span) const override { return inner_.bound(span); }
  Strands generate() const override { return inner_.generate(); }
  StrandCounts counts() const override { return inner_.counts(); }
  StrandScale scale() const override { return inner_.scale(); }
  ChunkBounds exact_bounds(BoundSpan span, int keys) const override {
    return inner_.exact_bounds(span, keys);
  }
  std::optional<BoundsRecord> bounds_record() const override { return record_; }

 private:
  const Procedural& inner_;
  BoundsRecord record_;
};

class RememberedBounds : public testing::Test {
 protected:
  RememberedBounds() {
    for (uint64_t coat = 0; coat < 2; ++coat) {
      for (size_t leaf = 0; leaf < coat_.chunks.size(); ++leaf) {
        BoundsRecord record{store_, {17, coat}, leaf, coat_.chunks.size()};
        leaves_.push_back(std::make_unique<Remembering>(*coat_.chunks[leaf], record));
        chunks_.push_back(leaves_.back().get());
      }
    }
  }
  std::vector<std::filesystem::path> files() const {
    std::vector<std::filesystem::path> found;
    for (const auto& entry : std::filesystem::recursive_directory_iterator(folder_.path())) {
      if (entry.is_regular_file()) found.push_back(entry.path());
    }
    std::sort(found.begin(), found.end());
    return found;
  }
  /// Bounds all chunks and checks how many were measured and remembered.
  void expect_bounds(int64_t measured, BoundingStrategy strategy, size_t warnings = 0) {
    BoundingCounts counts;
    std::vector<std::string> told;
    const auto bounds = bounds_of(
        chunks_, {strategy}, 3, [&](const std::string& line) { told.push_back(line); }, &counts);
    EXPECT_TRUE(same(bounds, bounds_of(both(), {strategy})));
    EXPECT_EQ(counts.measured, measured);
    EXPECT_EQ(counts.remembered, static_cast<int64_t>(chunks_.size()) - measured);
    EXPECT_EQ(told.size(), warnings);
    for (const std::string& line : told) EXPECT_NE(line.find("boxes"), std::string::npos) << line;
  }
  /// The same chunks without a memory.
  std::vector<const Procedural*> both() const {
    std::vector<const Procedural*> twice = coat_.chunks;
    twice.insert(twice.end(), coat_.chunks.begin(), coat_.chunks.end());
    return twice;
  }

  TemporaryFolder folder_;
  std::shared_ptr<const ContentStore> store_ = std::make_shared<ContentStore>(folder_.path());
  RandomCoat coat_{3, {.motion_keys = 3}};
  std::vector<std::unique_ptr<Procedural>> leaves_;
  std::vector<const Procedural*> chunks_;
};

TEST_F(RememberedBounds, AreMeasuredOncePerStrategy) {
  const auto all = static_cast<int64_t>(chunks_.size());
  for (BoundingStrategy strategy :
       {BoundingStrategy::kExact, BoundingStrategy::kExactShutter, BoundingStrategy::kLinear}) {
    expect_bounds(all, strategy);
    expect_bounds(0, strategy);
  }
  expect_bounds(0, BoundingStrategy::kExact);
}

TEST_F(RememberedBounds, AreMeasuredAgainWhenDamaged) {
  const auto half = static_cast<int64_t>(chunks_.size() / 2);
  expect_bounds(2 * half, BoundingStrategy::kExact);
  const auto entries = files();
  ASSERT_EQ(entries.size(), 2u);
  const auto size = static_cast<int64_t>(std::filesystem::file_size(entries[0]));
  for (int64_t at : {int64_t(0), int64_t(20), size / 2, size - 1}) {
    std::fstream file(entries[0], std::ios::in | std::ios::out | std::ios::binary);
    file.seekg(at);
    const char byte = static_cast<char>(file.get() ^ 0x10);
    file.seekp(at);
    file.put(byte);
    file.close();
    expect_bounds(half, BoundingStrategy::kExact, 1);  // with one warning
    expect_bounds(0, BoundingStrategy::kExact);        // and written anew
  }
  std::filesystem::resize_file(entries[1], static_cast<uintmax_t>(size / 2));
  expect_bounds(half, BoundingStrategy::kExact, 1);
  expect_bounds(0, BoundingStrategy::kExact);
}

// Checksums hold, but what they sum cannot be.
TEST_F(RememberedBounds, AreMeasuredAgainWhenImpossible) {
  const auto half = chunks_.size() / 2;
  const BoundsRecord record = *chunks_[0]->bounds_record();
  std::vector<ChunkBounds> wrong(half, ChunkBounds{1, {Box3f(V3f(0), V3f(1))}});
  const auto expect_refused = [&] {
    std::vector<const ChunkBounds*> entries;
    for (const ChunkBounds& chunk : wrong) entries.push_back(&chunk);
    write_bounds(record, BoundSpan::kFrame, 1, entries, expect_no_warning);
    expect_bounds(static_cast<int64_t>(half), BoundingStrategy::kExact, 1);
  };
  expect_bounds(static_cast<int64_t>(2 * half), BoundingStrategy::kExact);
  wrong[1].boxes[0].max.y = std::numeric_limits<float>::quiet_NaN();
  expect_refused();
  wrong[1].boxes[0].max.y = std::numeric_limits<float>::infinity();
  expect_refused();
  wrong.assign(half + 1, wrong[0]);
  expect_refused();
  wrong.assign(half - 1, wrong[0]);
  expect_refused();
}

// Files have the parts even where who makes them drops them.
TEST_F(RememberedBounds, CanBeHadInOnePart) {
  BoundingOptions options{BoundingStrategy::kExact};
  options.in_one_part = true;
  BoundingCounts cold_counts, warm_counts, counts;
  const std::vector<ChunkBounds> cold = bounds_of(chunks_, options, 2, expect_no_warning, &cold_counts);
  const std::vector<ChunkBounds> warm = bounds_of(chunks_, options, 2, expect_no_warning, &warm_counts);
  options.in_one_part = false;
  const std::vector<ChunkBounds> parts = bounds_of(chunks_, options, 2, expect_no_warning, &counts);
  EXPECT_EQ(cold_counts.measured, static_cast<int64_t>(chunks_.size()));
  EXPECT_EQ(warm_counts.measured, 0);
  EXPECT_EQ(counts.measured, 0);
  EXPECT_EQ(cold_counts.area.parts, counts.area.parts);
  EXPECT_EQ(warm_counts.area.parts, counts.area.parts);
  EXPECT_EQ(warm_counts.area.chunks, counts.area.chunks);
  size_t most = 0;
  for (size_t i = 0; i < chunks_.size(); ++i) {
    most = std::max(most, parts[i].part_count());
    for (const ChunkBounds* one : {&cold[i], &warm[i]}) {
      ASSERT_EQ(one->part_count(), 1u);
      EXPECT_EQ(one->boxes[0], parts[i].whole());
      EXPECT_TRUE(same(one->fine, parts[i].fine));
    }
  }
  EXPECT_GT(most, 1u);
}

TEST_F(RememberedBounds, OfPartOfACoatAreNotWritten) {
  chunks_.resize(chunks_.size() - 1);
  leaves_.pop_back();
  BoundingCounts counts;
  bounds_of(chunks_, {BoundingStrategy::kExact}, 2, expect_no_warning, &counts);
  EXPECT_EQ(files().size(), 1u);
}

// A coat with a cache remembers its boxes there, for that groom in that pose at that length.
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
