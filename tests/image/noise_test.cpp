// SPDX-License-Identifier: Apache-2.0
#include <cmath>
#include <limits>

#include <gtest/gtest.h>

#include "base/hash.h"
#include "image/field.h"

namespace pelage {
namespace {

V3f random_point(uint64_t i) {
  return 50.0f * V3f(signed_float(hash64(i, 1)), signed_float(hash64(i, 2)), signed_float(hash64(i, 3)));
}

TEST(Noise, IsZeroAtLatticePoints) {
  for (int i = 0; i < 200; ++i) {
    const V3f p(static_cast<float>(i % 7 - 3), static_cast<float>(i % 11 - 5), static_cast<float>(i - 100));
    EXPECT_EQ(perlin_noise(p), 0.0f);
    EXPECT_EQ(perlin_noise3(p, 9), V3f(0));
  }
}

TEST(Noise, IsContinuousAcrossCells) {
  const float step = 1e-4f;
  for (uint64_t i = 0; i < 2000; ++i) {
    V3f p = random_point(i);
    p.x = std::round(p.x);
    EXPECT_NEAR(perlin_noise(p - V3f(step, 0, 0)), perlin_noise(p + V3f(step, 0, 0)), 5e-4f);
  }
}

TEST(Noise, StaysWithinOneAndComesNearIt) {
  // The most that eight edge gradients can add up to, over the cell.
  double max = 0;
  const int steps = 64;
  const auto fade = [](double t) { return t * t * t * (t * (t * 6 - 15) + 10); };
  for (int i = 0; i <= steps; ++i) {
    for (int j = 0; j <= steps; ++j) {
      for (int k = 0; k <= steps; ++k) {
        const double p[3] = {double(i) / steps, double(j) / steps, double(k) / steps};
        double sum = 0;
        for (int corner = 0; corner < 8; ++corner) {
          double weight = 1, total = 0, min = 1;
          for (int axis = 0; axis < 3; ++axis) {
            const int bit = corner >> axis & 1;
            weight *= bit ? fade(p[axis]) : 1 - fade(p[axis]);
            const double d = std::abs(p[axis] - bit);
            total += d;
            min = std::min(min, d);
          }
          sum += weight * (total - min);  // the two longest components, signs as they please
        }
        max = std::max(max, sum);
      }
    }
  }
  EXPECT_NEAR(max, 1.036354, 2e-4);
  EXPECT_LE(max, 1.036354);

  float highest = 0;
  for (uint64_t i = 0; i < 200000; ++i) highest = std::max(highest, std::abs(perlin_noise(random_point(i))));
  EXPECT_LE(highest, 1.0f);
  EXPECT_GT(highest, 0.8f);
}

TEST(Noise, HasMeanZeroAndDecorrelatedChannels) {
  double sum[3] = {}, square[3] = {}, cross[3] = {}, seeds = 0;
  const int count = 100000;
  for (uint64_t i = 0; i < count; ++i) {
    const V3f n = perlin_noise3(random_point(i));
    for (int c = 0; c < 3; ++c) {
      sum[c] += n[c];
      square[c] += double(n[c]) * n[c];
      cross[c] += double(n[c]) * n[(c + 1) % 3];
    }
    seeds += double(n.x) * perlin_noise(random_point(i), 1);
  }
  for (int c = 0; c < 3; ++c) {
    const double variance = square[c] / count;
    EXPECT_NEAR(sum[c] / count, 0, 5 * std::sqrt(variance / count));
    EXPECT_NEAR(cross[c] / count / variance, 0, 5 / std::sqrt(count));
    EXPECT_NEAR(seeds / count / variance, 0, 5 / std::sqrt(count));
  }
}

TEST(Noise, FirstOfThreeIsTheOne) {
  for (uint64_t i = 0; i < 100; ++i) {
    EXPECT_EQ(perlin_noise(random_point(i), 5), perlin_noise3(random_point(i), 5).x);
  }
}

TEST(Noise, IsTheSameEverywhere) { EXPECT_EQ(perlin_noise(V3f(0.5f, 0.25f, 0.125f)), 0.58807057f); }

TEST(Noise, OfAbsurdPointsIsZero) {
  const float infinity = std::numeric_limits<float>::infinity();
  EXPECT_EQ(perlin_noise(V3f(infinity, 0.5f, 0.5f)), 0.0f);
  EXPECT_EQ(perlin_noise(V3f(std::nanf(""), 0.5f, 0.5f)), 0.0f);
  EXPECT_EQ(perlin_noise(V3f(0.5f, 1e30f, 0.5f)), 0.0f);
}

}  // namespace
}  // namespace pelage
