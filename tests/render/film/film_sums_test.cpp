// SPDX-License-Identifier: Apache-2.0
#include "render/film/film_sums.h"

#include <cmath>
#include <vector>

#include <gtest/gtest.h>

#include "base/hash.h"

namespace pelage::film_sums_test {
namespace {

constexpr int kWidth = 37, kHeight = 21;  // three tiles by two, the last ones cut off
constexpr size_t kChannels = 2;
const std::vector<uint32_t> kEqual(static_cast<size_t>(kWidth* kHeight), 1);  // counts of samples

struct Sample {
  int x, y;
  V2f offset;
  std::vector<float> values;
};

Sample random_sample(uint64_t i) {
  const auto number = [i](uint64_t use) { return unit_float(hash64(i, use)); };
  return {static_cast<int>(number(0) * kWidth),
          static_cast<int>(number(1) * kHeight),
          V2f(number(2) - 0.5f, number(3) - 0.5f),
          {number(4), 10 * number(5)}};
}

void add(FilmSums& sums, const Sample& sample) {
  const FilmSums::Footprint footprint = sums.footprint(sample.offset);
  sums.add(sample.x, sample.y, footprint, sample.values);
  sums.add_weight(sample.x, sample.y, footprint);
}

TEST(PixelFilter, IntegralIsThatOfTheValue) {
  for (const PixelFilter filter : {PixelFilter::kBox, PixelFilter::kBlackmanHarris}) {
    const double radius = filter_radius(filter);
    constexpr int kSteps = 20000;
    const auto place = [&](double step) { return -radius + 2 * radius * step / kSteps; };
    double whole = 0;
    for (int i = 0; i < kSteps; ++i) whole += filter_value(filter, static_cast<float>(place(i + 0.5)));
    double sum = 0;
    for (int i = 0; i < kSteps; ++i) {
      sum += filter_value(filter, static_cast<float>(place(i + 0.5)));
      ASSERT_NEAR(sum / whole, filter_integral(filter, place(i + 1)), 1e-4) << place(i + 1);
    }
    EXPECT_NEAR(filter_value(filter, 0), 1, 1e-6);
    EXPECT_EQ(filter_value(filter, static_cast<float>(radius) + 0.01f), 0);
  }
}

TEST(PixelFilter, ValuesAroundASampleAreThoseOfEachPixel) {
  for (PixelFilter filter : {PixelFilter::kBox, PixelFilter::kBlackmanHarris}) {
    for (int i = -50; i <= 50; ++i) {
      const float at = 0.00999f * static_cast<float>(i);
      const auto around = filter_around(filter, at);
      for (int k = 0; k < 3; ++k) {
        EXPECT_NEAR(around[static_cast<size_t>(k)], filter_value(filter, static_cast<float>(k - 1) - at),
                    1e-6f)
            << at << ", pixel " << k - 1;
      }
    }
  }
}

TEST(FilmSums, SplattedPixelsAreFilteredMeansOfAllSamplesAround) {
  for (const PixelFilter filter : {PixelFilter::kBox, PixelFilter::kBlackmanHarris}) {
    FilmSums sums(kWidth, kHeight, kChannels, filter);
    std::vector<Sample> samples;
    for (uint64_t i = 0; i < 3000; ++i) samples.push_back(random_sample(i));
    for (const Sample& sample : samples) add(sums, sample);
    for (int y = 0; y < kHeight; ++y) {
      for (int x = 0; x < kWidth; ++x) {
        double weights = 0, values[kChannels] = {};
        for (const Sample& s : samples) {
          const double weight = double{filter_value(filter, static_cast<float>(s.x - x) + s.offset.x)} *
                                filter_value(filter, static_cast<float>(s.y - y) + s.offset.y);
          weights += weight;
          for (size_t c = 0; c < kChannels; ++c) values[c] += weight * s.values[c];
        }
        for (size_t c = 0; c < kChannels; ++c) {
          const double expected = weights > 0 ? values[c] / weights : 0;
          ASSERT_NEAR(sums.mean(x, y, c, kEqual), expected, 1e-5 * (1 + expected)) << x << " " << y;
        }
      }
    }
  }
}

TEST(FilmSums, DrawnSamplesCountForTheirOwnPixel) {
  FilmSums sums(kWidth, kHeight, kChannels, std::nullopt);
  add(sums, {16, 15, V2f(1.4f, -1.2f), {3, 4}});
  add(sums, {16, 15, V2f(0), {5, 0}});
  EXPECT_EQ(sums.mean(16, 15, 0, kEqual), 4);
  EXPECT_EQ(sums.mean(16, 15, 1, kEqual), 2);
  EXPECT_EQ(sums.mean(15, 15, 0, kEqual), 0);
  EXPECT_EQ(sums.mean(17, 14, 1, kEqual), 0);
}

/// Twenty times as many samples in one tile change no pixel, if they are the same ones.
TEST(FilmSums, TilesCountEquallyWhateverTheirSamples) {
  FilmSums once(kWidth, kHeight, kChannels, PixelFilter::kBlackmanHarris);
  FilmSums more(kWidth, kHeight, kChannels, PixelFilter::kBlackmanHarris);
  std::vector<uint32_t> counts = kEqual;
  for (int y = 0; y < kHeight; ++y) {
    for (int x = 0; x < kWidth; ++x) {
      Sample sample = random_sample(static_cast<uint64_t>(y * kWidth + x));
      sample.x = x;
      sample.y = y;
      const bool in_tile = x < FilmSums::kTileSide && y < FilmSums::kTileSide;
      add(once, sample);
      for (int i = 0; i < (in_tile ? 20 : 1); ++i) add(more, sample);
      if (in_tile) counts[static_cast<size_t>(y * kWidth + x)] = 20;
    }
  }
  for (int y = 0; y < kHeight; ++y) {
    for (int x = 0; x < kWidth; ++x)
      ASSERT_NEAR(more.mean(x, y, 1, counts), once.mean(x, y, 1, kEqual), 1e-4) << x << " " << y;
  }
}

/// Tiles may be traced in any order; only within a tile do samples follow each other.
TEST(FilmSums, OrderOfTilesDoesNotMatter) {
  FilmSums forward(kWidth, kHeight, kChannels, PixelFilter::kBlackmanHarris);
  FilmSums backward(kWidth, kHeight, kChannels, PixelFilter::kBlackmanHarris);
  const auto tile_of = [](const Sample& s) {
    return s.y / FilmSums::kTileSide * 3 + s.x / FilmSums::kTileSide;
  };
  for (int step = 0; step < 6; ++step) {
    for (uint64_t i = 0; i < 2000; ++i) {
      const Sample sample = random_sample(i);
      if (tile_of(sample) == step) add(forward, sample);
      if (tile_of(sample) == 5 - step) add(backward, sample);
    }
  }
  for (int y = 0; y < kHeight; ++y) {
    for (int x = 0; x < kWidth; ++x) ASSERT_EQ(forward.mean(x, y, 1, kEqual), backward.mean(x, y, 1, kEqual));
  }
}

}  // namespace
}  // namespace pelage::film_sums_test
