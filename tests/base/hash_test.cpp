// SPDX-License-Identifier: Apache-2.0
#include "base/hash.h"

#include <array>
#include <bit>
#include <cmath>
#include <set>
#include <span>
#include <string_view>
#include <vector>

#include <gtest/gtest.h>

namespace pelage {
namespace {

TEST(Mix64, IsTheFinaliserOfSplitMix64) {
  // First three outputs of Vigna's splitmix64 seeded with 0, whose state advances by the golden ratio.
  const uint64_t golden = 0x9e3779b97f4a7c15ull;
  EXPECT_EQ(mix64(golden), 0xe220a8397b1dcdafull);
  EXPECT_EQ(mix64(2 * golden), 0x6e789e6aa1b965f4ull);
  EXPECT_EQ(mix64(3 * golden), 0x06c45d188009454full);
}

TEST(RandomUse, IsFnv1a) {
  static_assert(random_use("") == 0xcbf29ce484222325ull);
  static_assert(random_use("a") == 0xaf63dc4c8601ec8cull);
  static_assert(random_use("foobar") == 0x85944171f73967e8ull);
  EXPECT_NE(random_use("clump"), random_use("clumq"));
}

TEST(Hash64, DependsOnEveryWordAndOnTheirOrder) {
  EXPECT_NE(hash64(1, 2), hash64(2, 1));
  EXPECT_NE(hash64(1), hash64(1, 0));
  EXPECT_NE(hash64(0), hash64(0, 0));
  std::set<uint64_t> seen;
  for (uint64_t seed = 0; seed < 16; ++seed) {
    for (uint64_t strand = 0; strand < 4096; ++strand) seen.insert(hash64(seed, strand, random_use("test")));
  }
  EXPECT_EQ(seen.size(), 16u * 4096u);
}

// Flipping any bit of any word flips each bit of the hash in half of the cases.
TEST(Hash64, Avalanches) {
  constexpr int kTrials = 4096;
  for (int word = 0; word < 3; ++word) {
    for (int bit = 0; bit < 64; bit += 7) {
      std::array<int, 64> flips{};
      for (int trial = 0; trial < kTrials; ++trial) {
        std::array<uint64_t, 3> words{uint64_t(trial), uint64_t(trial) * 3, 17};
        const uint64_t before = hash64(words[0], words[1], words[2]);
        words[static_cast<size_t>(word)] ^= uint64_t(1) << bit;
        const uint64_t changed = before ^ hash64(words[0], words[1], words[2]);
        for (size_t i = 0; i < 64; ++i) flips[i] += static_cast<int>(changed >> i & 1);
      }
      // Six standard deviations of a fair coin, over 3 * 10 * 64 counts.
      for (int count : flips)
        EXPECT_NEAR(count, 0.5 * kTrials, 6 * std::sqrt(0.25 * kTrials)) << word << " " << bit;
    }
  }
}

// Chi-square of 256 bins over the hashes of consecutive strands, which is how they are used.
TEST(UnitFloat, IsUniformOverConsecutiveStrands) {
  constexpr int kCount = 1 << 18, kBins = 256;
  std::vector<int> bins(kBins);
  for (uint64_t strand = 0; strand < kCount; ++strand) {
    const float u = unit_float(hash64(7, strand, random_use("test")));
    ASSERT_GE(u, 0.0f);
    ASSERT_LT(u, 1.0f);
    ++bins[static_cast<size_t>(u * kBins)];
  }
  double chi_square = 0;
  const double expected = double(kCount) / kBins;
  for (int count : bins) chi_square += (count - expected) * (count - expected) / expected;
  // 255 degrees of freedom: mean 255, standard deviation 22.6; 99.99 % quantile 347.
  EXPECT_LT(chi_square, 347);
  EXPECT_GT(chi_square, 255 - 4 * 22.6);
}

TEST(UnitFloat, CoversItsIntervalToTheLastBit) {
  EXPECT_EQ(unit_float(0), 0.0f);
  EXPECT_EQ(unit_float(~uint64_t(0)), 1.0f - 0x1p-24f);
  EXPECT_EQ(signed_float(0), -1.0f);
  EXPECT_LT(signed_float(~uint64_t(0)), 1.0f);
}

TEST(ContentHash, IsXxh3Of128Bits) {
  const ContentHash empty = content_hash({});
  EXPECT_EQ(empty.high, 0x99aa06d3014798d8ull);
  EXPECT_EQ(empty.low, 0x6001c324468d497full);
}

TEST(ContentHash, DependsOnEveryByteTheLengthAndTheSeed) {
  std::vector<std::byte> bytes(1000);
  const ContentHash before = content_hash(bytes);
  EXPECT_EQ(content_hash(bytes), before);
  EXPECT_FALSE(content_hash(bytes, 1) == before);
  EXPECT_FALSE(content_hash(std::span(bytes).first(999)) == before);
  for (size_t i = 0; i < bytes.size(); i += 111) {
    bytes[i] = std::byte{1};
    EXPECT_FALSE(content_hash(bytes) == before) << i;
    bytes[i] = std::byte{0};
  }
}

TEST(ContentHasher, HashesTheSameBytesAsOneCallDoes) {
  std::vector<std::byte> bytes(100'000);
  for (size_t i = 0; i < bytes.size(); ++i) bytes[i] = static_cast<std::byte>(mix64(i));
  ContentHasher pieces;
  for (size_t at = 0, size = 1; at < bytes.size(); at += size, size = size * 3 % 1009) {
    pieces.add_bytes(std::span(bytes).subspan(at, std::min(size, bytes.size() - at)));
  }
  EXPECT_EQ(pieces.digest(), content_hash(bytes));
  EXPECT_EQ(pieces.digest(), content_hash(bytes)) << "asking changes nothing";
}

TEST(ContentHasher, TellsWhereOnePieceEnds) {
  EXPECT_NE(ContentHasher().add("ab").add("c").digest(), ContentHasher().add("a").add("bc").digest());
  EXPECT_NE(ContentHasher().add("").digest(), ContentHasher().digest());
  EXPECT_NE(ContentHasher().add(1.0f).digest(), ContentHasher().add(1).digest());
  const std::array<float, 2> list{1, 2};
  EXPECT_NE(ContentHasher().add(std::span<const float>(list)).digest(),
            ContentHasher().add(1.0f).add(2.0f).digest());
  EXPECT_EQ(to_string(ContentHash{0xabcull, 0x12ull}), "00000000000000120000000000000abc");
}

}  // namespace
}  // namespace pelage
