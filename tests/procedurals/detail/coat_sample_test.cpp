// SPDX-License-Identifier: Apache-2.0
#include "procedurals/detail/coat_sample.h"

#include <gtest/gtest.h>

#include "procedurals/detail/coat_stats.h"
#include "tests/procedurals/random_coats.h"

namespace pelage {
namespace {

struct Sampled {
  uint64_t id;
  std::vector<float> points;
  bool operator==(const Sampled&) const = default;
};

std::vector<Sampled> sample_of(const RandomCoat& coat, uint64_t count) {
  std::vector<Sampled> all;
  visit_coat_sample(*coat.groom, coat.rest.get(), count, Workers(2), [&](const Strands& strands, size_t s) {
    const auto points =
        strands.points(0).subspan(strands.first_point(s) * size_t(4), strands.strand_points(s) * size_t(4));
    all.push_back({strands.id(s), {points.begin(), points.end()}});
  });
  return all;
}

TEST(CoatSample, ComesInTheOrderOfIdsForAnyLeaves) {
  for (const bool push_out : {false, true}) {
    RandomCoatOptions options;
    options.push_out = push_out;
    options.leaf_strands = 8000;
    const RandomCoat whole(3, options);
    const std::vector<Sampled> sample = sample_of(whole, 500);
    ASSERT_EQ(sample.size(), 500u);
    for (size_t i = 0; i < sample.size(); ++i) EXPECT_EQ(sample[i].id, i);
    for (const int leaf_strands : {300, 37}) {
      options.leaf_strands = leaf_strands;
      EXPECT_TRUE(sample_of(RandomCoat(3, options), 500) == sample) << leaf_strands;
    }
    EXPECT_EQ(sample_of(whole, 1 << 20).size(), 900u);  // there are no more
  }
}

TEST(CoatSample, WhatAStrandIsLikeDoesNotDependOnLeaves) {
  for (const uint64_t seed : {4, 5, 6, 7}) {
    RandomCoatOptions options;
    options.leaf_strands = 8000;
    const RandomCoat whole(seed, options);
    const CoatStats stats = coat_stats(*whole.groom, whole.rest.get(), Workers(1));
    options.leaf_strands = 23;
    const RandomCoat divided(seed, options);
    const CoatStats other = coat_stats(*divided.groom, divided.rest.get(), Workers(1));
    EXPECT_EQ(stats.width, other.width);
    EXPECT_EQ(stats.length, other.length);
    EXPECT_EQ(stats.area_share, other.area_share);
    EXPECT_EQ(stats.density, other.density);
  }
}

}  // namespace
}  // namespace pelage
