// SPDX-License-Identifier: Apache-2.0
#include "render/accel/fur_chunk_file.h"

#include <cstring>
#include <limits>

#include <gtest/gtest.h>

#include "base/error.h"
#include "base/file.h"
#include "base/stored_file_layout.h"
#include "base/temporary_folder.h"
#include "render/accel/fur/fur_leaf.h"
#include "tests/fuzz/right_checksums.h"
#include "tests/render/accel/chunk_accel_fixture.h"
#include "tests/support/effort.h"

namespace pelage {
namespace {

constexpr ContentHash kKey{3, 4};

class FurChunkFileTest : public ChunkAccelTest {
 protected:
  FurChunkFileTest() : store_(folder_.path()) {}

  static ResidentChunksOptions fur_options() {
    ResidentChunksOptions options;
    options.kind = AccelKind::kFur;
    return options;
  }
  void write(const TestChunks& chunks) {
    FurChunkFile::Writer writer(store_, kKey);
    for (uint32_t c = 0; c < chunks.contents.size(); ++c) {
      std::unique_ptr<FurChunk> chunk;
      if (std::holds_alternative<FurContents>(chunks.contents[c].geometry)) {
        const StrandScale scale = chunks.scale(c);
        FurChunkOptions options;
        options.tree.build.rotation = FurRotation::kAlways;
        chunk = std::make_unique<FurChunk>(chunks.grow(c), c, FurGrid(scale), options);
      }
      writer.add(chunk.get());
    }
    ASSERT_TRUE(writer.commit(sink()));
  }
  std::unique_ptr<const FurChunkFile> open(size_t chunks) {
    return FurChunkFile::open(store_, kKey, chunks, sink());
  }
  void rewrite(const std::filesystem::path& place, const std::string& bytes) {
    AtomicFile file(place);
    file.write(bytes);
    file.commit();
    warnings_ = 0;
  }
  std::filesystem::path path() const { return std::filesystem::directory_iterator(folder_.path())->path(); }
  WarningSink sink() {
    return [this](const std::string&) { ++warnings_; };
  }

  TemporaryFolder folder_;
  ContentStore store_;
  int warnings_ = 0;
};

class FurChunkFileScenes : public FurChunkFileTest, public testing::WithParamInterface<int> {};

TEST_P(FurChunkFileScenes, answer_as_chunks_that_are_grown) {
  const TestChunks chunks = random_chunks(7, scene_of_kind(GetParam()));
  write(chunks);
  ResidentChunksOptions options = fur_options();
  const auto grown = make(chunks, chunks.bounds(8), options);
  options.file = open(chunks.contents.size());
  ASSERT_TRUE(options.file);
  const auto read = make(chunks, chunks.bounds(8), options);
  expect_same(*grown, *read, 1, repetitions(1500));
  EXPECT_GT(options.file->reads().chunks, 0);
  EXPECT_EQ(read->chunks().counts().overruns, 0);
  const auto boxed = make(chunks, chunks.measured_bounds(1), options);
  expect_same(*grown, *boxed, 2, repetitions(1000));
  expect_same_strands(grown->chunks(), read->chunks());
  EXPECT_EQ(warnings_, 0);
}

INSTANTIATE_TEST_SUITE_P(All, FurChunkFileScenes, testing::Range(0, kSceneKinds));

TEST_F(FurChunkFileTest, is_read_again_under_a_budget) {
  RandomChunkOptions o;
  o.chunks = 40;
  o.strands = 40;
  const TestChunks chunks = random_chunks(17, o);
  write(chunks);
  ResidentChunksOptions options = fur_options();
  const auto grown = make(chunks, chunks.bounds(8), options);
  options.file = open(chunks.contents.size());
  expect_same(*grown, *make(chunks, chunks.bounds(8), options), 5, 300);  // these rays make it grow no more
  size_t largest = 0;
  for (uint32_t c = 0; c < chunks.contents.size(); ++c) {
    largest = std::max(largest, options.file->has(c) ? options.file->bytes_bound(c)
                                                     : EmbreeChunk::bytes_bound(chunks.counts(c)) +
                                                           part_bounds_scratch(chunks.counts(c)));
  }
  const int64_t before = ledger_.budgeted();
  const int64_t fixed = [&] {
    const auto idle = make(chunks, chunks.bounds(8), options);
    return ledger_.budgeted() - before;
  }();
  options.memory_limit = static_cast<uint64_t>(before + fixed + 16384 + 3 * static_cast<int64_t>(largest));
  const auto read = make(chunks, chunks.bounds(8), options);
  expect_same(*grown, *read, 5, 300);
  EXPECT_GT(read->chunks().counts().evictions, 0);
  EXPECT_GT(options.file->reads().chunks, static_cast<int64_t>(chunks.contents.size()) / 2);
  EXPECT_EQ(read->chunks().counts().overruns, 0);
}

TEST_F(FurChunkFileTest, notices_damage) {
  const TestChunks chunks = random_chunks(7, scene_of_kind(2));
  write(chunks);
  const std::filesystem::path place = path();
  const std::string whole = read_file(place);
  int opened = 0, noticed = 0;
  for (uint64_t i = 0; i < 40; ++i) {
    std::string damaged = whole;
    const size_t at = hash64(i, 1) % damaged.size();
    damaged[at] = static_cast<char>(damaged[at] ^ (1 << hash64(i, 2) % 8));
    rewrite(place, damaged);
    const auto file = open(chunks.contents.size());
    if (file) {
      ++opened;
      int lost = 0;
      for (int round = 0; round < 2; ++round) {
        for (uint32_t c = 0; c < file->chunk_count(); ++c) {
          if (!file->has(c)) continue;
          const bool good = file->read(c, sink()) != nullptr;
          EXPECT_EQ(file->has(c), good);
          lost += !good;
        }
      }
      EXPECT_LE(lost, 1) << at;  // the others are there still
      EXPECT_EQ(warnings_, lost);
      EXPECT_EQ(std::filesystem::exists(place), lost == 0);
    }
    noticed += warnings_;
    EXPECT_LE(warnings_, 1) << at;
  }
  EXPECT_GT(noticed, 35);  // not in gaps between sections
  EXPECT_GT(opened, 30);
  for (const size_t bytes : {size_t(0), size_t(100), whole.size() / 2, whole.size() - 1}) {
    rewrite(place, whole.substr(0, bytes));
    EXPECT_FALSE(open(chunks.contents.size()));
    EXPECT_EQ(warnings_, 1);
  }
  rewrite(place, whole);
  EXPECT_FALSE(open(chunks.contents.size() + 1));  // of another frame
  EXPECT_EQ(warnings_, 1);
}

// Growing takes more memory than reading; under a budget too, that is what is reserved.
TEST_F(FurChunkFileTest, chunks_that_are_damaged_are_grown) {
  RandomChunkOptions o;
  o.chunks = 30;
  o.strands = 60;
  o.skins = false;
  const TestChunks chunks = random_chunks(23, o);
  write(chunks);
  const std::filesystem::path place = path();
  std::string bytes = read_file(place);
  for (size_t at = 2000; at + 20000 < bytes.size(); at += 20000) bytes[at] ^= 1;
  ResidentChunksOptions options = fur_options();
  const auto grown = make(chunks, chunks.bounds(8), options);
  const auto boxes = [&] { return chunks.measured_bounds(1); };
  size_t largest = 0;
  for (uint32_t c = 0; c < chunks.contents.size(); ++c)
    largest = std::max(largest, FurChunk::bytes_bound(chunks.counts(c), options.fur));
  for (const bool limited : {false, true}) {
    rewrite(place, bytes);
    options.file = open(chunks.contents.size());
    ASSERT_TRUE(options.file);
    if (limited) {
      const int64_t before = ledger_.budgeted();
      const auto idle = make(chunks, boxes(), options);
      options.memory_limit = static_cast<uint64_t>(ledger_.budgeted() + 16384 + 2 * int64_t(largest));
      EXPECT_GT(ledger_.budgeted(), before);
    }
    const auto mixed = make(chunks, boxes(), options);
    expect_same(*grown, *mixed, 9, repetitions(1500));
    size_t lost = 0;
    for (uint32_t c = 0; c < chunks.contents.size(); ++c) lost += !options.file->has(c);
    EXPECT_GT(lost, 3u);
    EXPECT_LT(lost, chunks.contents.size() - 3);
    EXPECT_GT(options.file->reads().chunks, 3);
    EXPECT_EQ(progress_.warnings, limited ? 2 : 1);
    EXPECT_FALSE(std::filesystem::exists(place));
    EXPECT_EQ(mixed->chunks().counts().overruns, 0);
    EXPECT_EQ(mixed->chunks().counts().evictions > 0, limited);
    options.memory_limit = 0;
  }
}

// As if checksums were right.
TEST_F(FurChunkFileTest, refuses_what_no_chunk_is) {
  const TestChunks chunks = random_chunks(7, scene_of_kind(0));
  write(chunks);
  const std::filesystem::path place = path();
  const std::string whole = read_file(place);
  const StoredFileLayout layout =
      StoredFileLayout::read(place, whole.size(), [&](uint64_t offset, std::span<std::byte> out) {
        std::memcpy(out.data(), &whole[offset], out.size());
      });
  const uint64_t head = layout.sections[0].offset, leaves = layout.sections[3].offset;
  const auto is_read_with = [&](uint64_t at, auto value) {
    std::string bytes = whole;
    std::memcpy(&bytes[at], &value, sizeof(value));
    const auto mended = with_right_checksums({reinterpret_cast<const uint8_t*>(bytes.data()), bytes.size()});
    rewrite(place, std::string(mended.begin(), mended.end()));
    const auto file = open(chunks.contents.size());
    return file && file->read(0, sink()) != nullptr;
  };
  float low = 0;
  std::memcpy(&low, &whole[head + 32], sizeof(low));
  EXPECT_TRUE(is_read_with(head + 32, low));
  // A box that holds nothing.
  EXPECT_FALSE(is_read_with(head + 32, std::numeric_limits<float>::quiet_NaN()));
  EXPECT_FALSE(is_read_with(head + 32, 1e20f));
  // A segment that is another, that there is not, or that has no number.
  EXPECT_TRUE(is_read_with(leaves + 16, uint32_t(1)));
  EXPECT_FALSE(is_read_with(leaves + 16, uint32_t(1000000)));
  EXPECT_FALSE(is_read_with(leaves + 16, FurBlockHeader::kNone));
}

// The same: what is known of a chunk is changed, number by number.
TEST_F(FurChunkFileTest, refuses_packed_strands_that_reach_beyond_their_block) {
  const TestChunks chunks = random_chunks(7, scene_of_kind(0));
  const Strands& strands = std::get<FurContents>(chunks.contents[0].geometry).strands;
  const PackedStrands packed(strands, {}, true);
  const std::vector<std::byte> head = packed.stored_head();
  const auto block = [&] {
    PageBlock copy(packed.stored_block().size());
    std::copy(packed.stored_block().begin(), packed.stored_block().end(), copy.data());
    return copy;
  };
  ASSERT_TRUE(PackedStrands::from_stored(head, block()));
  for (uint64_t i = 0; i < 4000; ++i) {
    std::vector<std::byte> damaged = head;
    for (uint64_t k = 0; k <= i % 3; ++k) {
      const size_t at = hash64(i, k, 1) % damaged.size();
      damaged[at] = static_cast<std::byte>(hash64(i, k, 2));
    }
    const auto read = PackedStrands::from_stored(damaged, block());
    if (!read || read->segment_count() > 10 * packed.segment_count()) continue;
    // What was accepted can be read.
    for (uint32_t s = 0; s < std::min<size_t>(read->strand_count(), 50); ++s) {
      const StrandArrays a = read->bezier_strand(s, {});
      EXPECT_EQ(a.ids.size(), 1u);
      read->opacity({s, 0}, 0.5f);
    }
  }
  for (size_t bytes = 0; bytes < head.size(); ++bytes) {
    EXPECT_FALSE(PackedStrands::from_stored(std::span(head).first(bytes), block()));
  }
}

}  // namespace
}  // namespace pelage
