// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <array>
#include <fstream>
#include <string>
#include <thread>

#include <gtest/gtest.h>

#include "base/temporary_folder.h"
#include "procedurals/bounds/bounds_file.h"
#include "procedurals/bounds/segment_parts.h"
#include "tests/procedurals/bounds_checks.h"
#include "tests/procedurals/random_coats.h"

namespace pelage {
namespace {

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
  size_t max = 0;
  for (size_t i = 0; i < chunks_.size(); ++i) {
    max = std::max(max, parts[i].part_count());
    for (const ChunkBounds* one : {&cold[i], &warm[i]}) {
      ASSERT_EQ(one->part_count(), 1u);
      EXPECT_EQ(one->boxes[0], parts[i].whole());
      EXPECT_TRUE(same(one->cell_bounds, parts[i].cell_bounds));
    }
  }
  EXPECT_GT(max, 1u);
}

TEST_F(RememberedBounds, OfPartOfACoatAreNotWritten) {
  chunks_.resize(chunks_.size() - 1);
  leaves_.pop_back();
  BoundingCounts counts;
  bounds_of(chunks_, {BoundingStrategy::kExact}, 2, expect_no_warning, &counts);
  EXPECT_EQ(files().size(), 1u);
}

// Regions of a frame that start at the same time.
TEST_F(RememberedBounds, AreMeasuredByOneOfManyProcesses) {
  std::array<BoundingCounts, 4> counts;
  std::vector<std::thread> processes;
  for (BoundingCounts& each : counts) {
    processes.emplace_back([this, &each] {
      const auto bounds = bounds_of(chunks_, {BoundingStrategy::kExact}, 1, expect_no_warning, &each);
      EXPECT_TRUE(same(bounds, bounds_of(both(), {BoundingStrategy::kExact})));
    });
  }
  for (std::thread& process : processes) process.join();
  int64_t measured = 0;
  for (const BoundingCounts& each : counts) measured += each.measured;
  EXPECT_EQ(measured, static_cast<int64_t>(chunks_.size()));
  EXPECT_EQ(files().size(), 2u);  // no lock is left
}

}  // namespace
}  // namespace pelage
