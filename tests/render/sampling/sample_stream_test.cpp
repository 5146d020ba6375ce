// SPDX-License-Identifier: Apache-2.0
#include "render/sampling/sample_stream.h"

#include <array>
#include <bitset>
#include <vector>

#include <gtest/gtest.h>

#include "tests/render/random.h"
#include "tests/support/chi_square.h"

namespace pelage {
namespace {

V2f draw2d(uint64_t seed, uint32_t x, uint32_t y, uint32_t sample, uint32_t draw) {
  SampleStream stream(seed, x, y, sample);
  stream.seek(draw);
  return stream.next2d();
}

TEST(SampleStream, SecondSobolCoordinateIsThatOfItsDirectionNumbers) {
  // v_0 = 1/2, v_k = v_(k-1) xor v_(k-1) / 2: the second dimension in every table of direction numbers.
  for (uint32_t index : {0u, 1u, 2u, 3u, 5u, 77u, 1023u, 65536u, 0xdeadbeefu, 0xffffffffu}) {
    uint32_t expected = 0, v = 1u << 31;
    for (int k = 0; k < 32; ++k, v ^= v >> 1) {
      if (index >> k & 1) expected ^= v;
    }
    EXPECT_EQ(detail::reverse_bits(detail::sobol_second_reversed(index)), expected) << index;
  }
}

TEST(SampleStream, ScramblingIsANestedPermutation) {
  // Numbers that agree in their lowest k bits still do afterwards, and numbers that differ there still
  // differ.
  TestRandom random(1);
  for (int i = 0; i < 20000; ++i) {
    const auto word = [&] { return static_cast<uint32_t>(random.unit() * 0x1p24f) * 2654435761u; };
    const uint32_t a = word(), b = word(), seed = word();
    const uint32_t before = a ^ b;
    const uint32_t after = detail::scramble_reversed(a, seed) ^ detail::scramble_reversed(b, seed);
    ASSERT_EQ(before & -before, after & -after);
  }
}

TEST(SampleStream, FirstPowersOfTwoOfEveryDrawAreNets) {
  for (uint32_t pixel = 0; pixel < 8; ++pixel) {
    for (uint32_t draw : {0u, 1u, 2u, 7u, 100u}) {
      for (int m = 0; m <= 10; ++m) {
        const uint32_t count = 1u << m;
        std::vector<V2f> points(count);
        for (uint32_t s = 0; s < count; ++s) points[s] = draw2d(3, pixel, 5, s, draw);
        // Every elementary interval of area 1 / count holds exactly one point.
        for (int a = 0; a <= m; ++a) {
          std::vector<int> hits(count, 0);
          for (const V2f& p : points) {
            const uint32_t i = static_cast<uint32_t>(p.x * static_cast<float>(1u << a));
            const uint32_t j = static_cast<uint32_t>(p.y * static_cast<float>(1u << (m - a)));
            ++hits[(i << (m - a)) + j];
          }
          for (int h : hits)
            ASSERT_EQ(h, 1) << "pixel " << pixel << " draw " << draw << " 2^" << m << " split " << a;
        }
      }
    }
  }
}

TEST(SampleStream, BranchesAreANetOfTheirOwn) {
  constexpr uint32_t kSamples = 16, kBranches = 4;
  std::vector<int> hits(size_t{kSamples} * kBranches, 0);
  for (uint32_t sample = 0; sample < kSamples; ++sample) {
    SampleStream stream(7, 1, 2, sample);
    stream.seek(3);
    unsigned quarters = 0;
    for (uint32_t branch = 0; branch < kBranches; ++branch) {
      SampleStream of_branch = stream.branch(branch, kBranches);
      EXPECT_EQ(of_branch.dimension(), 3u);
      const float u = of_branch.next1d();
      quarters |= 1u << static_cast<unsigned>(4 * u);
      ++hits[static_cast<size_t>(u * static_cast<float>(hits.size()))];
    }
    EXPECT_EQ(quarters, 0b1111u) << "the branches of a sample are stratified";
  }
  for (int h : hits) EXPECT_EQ(h, 1);
}

TEST(SampleStream, FirstPowersOfTwoAreStratifiedInOneDimension) {
  for (uint32_t draw : {0u, 3u, 9u}) {
    for (int m = 0; m <= 12; ++m) {
      std::vector<int> hits(size_t(1) << m, 0);
      for (uint32_t s = 0; s < hits.size(); ++s) {
        SampleStream stream(7, 1, 2, s);
        stream.seek(draw);
        ++hits[static_cast<size_t>(stream.next1d() * static_cast<float>(hits.size()))];
      }
      for (int h : hits) ASSERT_EQ(h, 1);
    }
  }
}

TEST(SampleStream, IsAFunctionOfItsKey) {
  SampleStream forward(11, 4, 5, 6);
  std::array<V3f, 5> first;
  for (V3f& u : first) u = forward.next3d();
  for (int k = 4; k >= 0; --k) {
    SampleStream again(11, 4, 5, 6);
    again.seek(2 * k);
    EXPECT_EQ(again.next3d(), first[k]);
  }
  // Written down once: a change of the streams is a change of every picture.
  const V2f u = draw2d(11, 4, 5, 6, 0);
  EXPECT_EQ(u.x, 0.333544493f);
  EXPECT_EQ(u.y, 0.333753407f);
  EXPECT_NE(draw2d(11, 4, 5, 6, 0), draw2d(12, 4, 5, 6, 0));
  EXPECT_NE(draw2d(11, 4, 5, 6, 0), draw2d(11, 5, 4, 6, 0));
  EXPECT_NE(draw2d(11, 4, 5, 6, 0), draw2d(11, 4, 5, 6, 1));
}

TEST(SampleStream, PixelsSeedsAndDrawsAreIndependent) {
  // Pairs of numbers that must have nothing to do with each other, in 16 x 16 cells.
  struct Case {
    const char* name;
    V2f (*pair)(uint32_t, uint32_t);
  };
  const Case cases[] = {
      {"single samples of a pixel and its right neighbour",
       [](uint32_t x, uint32_t y) { return V2f(draw2d(1, x, y, 0, 0).x, draw2d(1, x + 1, y, 0, 0).x); }},
      {"and its lower neighbour",
       [](uint32_t x, uint32_t y) { return V2f(draw2d(1, x, y, 3, 0).y, draw2d(1, x, y + 1, 3, 0).y); }},
      {"x and y of a sample", [](uint32_t x, uint32_t y) { return draw2d(1, x, y, 1, 2); }},
      {"successive draws",
       [](uint32_t x, uint32_t y) { return V2f(draw2d(1, x, y, 0, 0).x, draw2d(1, x, y, 0, 1).x); }},
      {"seeds", [](uint32_t x, uint32_t y) { return V2f(draw2d(1, x, y, 0, 0).x, draw2d(2, x, y, 0, 0).x); }},
      {"transposed pixels",
       [](uint32_t x, uint32_t y) {
         return V2f(draw2d(1, 2 * x, 2 * y + 1, 0, 0).x, draw2d(1, 2 * y + 1, 2 * x, 0, 0).x);
       }},
  };
  for (const Case& c : cases) {
    std::vector<double> observed(256, 0.0);
    for (uint32_t x = 0; x < 256; ++x) {
      for (uint32_t y = 0; y < 256; ++y) {
        const V2f p = c.pair(x, y);
        observed[static_cast<int>(p.x * 16) * 16 + static_cast<int>(p.y * 16)] += 1;
      }
    }
    const ChiSquare test = chi_square(observed, std::vector<double>(256, 256.0));
    EXPECT_GT(test.p, sidak_level(1e-3, std::size(cases))) << c.name;
    EXPECT_LT(test.p, 1 - sidak_level(1e-3, std::size(cases))) << c.name << ": too even to be independent";
  }
}

TEST(SampleStream, DrawsOfOnePixelAreUncorrelatedOverItsSamples) {
  // Pairing of the points of two draws: 256 samples, cells of 4 x 4, over many pixels. Were the indices not
  // shuffled, the pairs would lie on a few lines.
  std::vector<double> observed(256, 0.0);
  constexpr uint32_t kPixels = 512, kSamples = 64;
  for (uint32_t x = 0; x < kPixels; ++x) {
    for (uint32_t s = 0; s < kSamples; ++s) {
      SampleStream stream(5, x, 0, s);
      const V2f a = stream.next2d(), b = stream.next2d();
      observed[static_cast<int>(a.x * 16) * 16 + static_cast<int>(b.y * 16)] += 1;
    }
  }
  // Each margin is stratified, so that cells vary less than independent ones: only the upper tail is a fault.
  const std::vector<double> expected(256, kPixels * kSamples / 256.0);
  EXPECT_GT(chi_square(observed, expected).p, 1e-3);
  for (double count : observed) EXPECT_GT(count, 0.5 * expected[0]);
}

/// Root-mean-square error over pixels of the mean of f over `samples` samples.
template <class Draw>
double rms_error(uint32_t samples, double truth, Draw&& f) {
  RunningMean squares;
  for (uint32_t pixel = 0; pixel < 200; ++pixel) {
    double sum = 0;
    for (uint32_t s = 0; s < samples; ++s) sum += f(pixel, s);
    const double off = sum / samples - truth;
    squares.add(off * off);
  }
  return std::sqrt(squares.mean());
}

TEST(SampleStream, ConvergesFasterThanRandom) {
  const auto smooth = [](const V2f& u) { return std::sin(3 * u.x + 1) * std::exp(u.y) * u.x; };
  double truth = 0;
  for (int i = 0; i < 512; ++i) {
    for (int j = 0; j < 512; ++j) truth += smooth({(i + 0.5f) / 512, (j + 0.5f) / 512}) / (512.0 * 512.0);
  }
  const auto low_discrepancy = [&](uint32_t n) {
    return rms_error(n, truth, [&](uint32_t pixel, uint32_t s) { return smooth(draw2d(9, pixel, 1, s, 0)); });
  };
  TestRandom random(2);
  const auto independent = [&](uint32_t n) {
    return rms_error(n, truth, [&](uint32_t, uint32_t) { return smooth(random.unit2()); });
  };
  // Error of scrambled nets falls as n^-1.5 for smooth integrands, of independent numbers as n^-0.5.
  const double at_16 = low_discrepancy(16), at_256 = low_discrepancy(256);
  EXPECT_LT(at_16, 0.25 * independent(16));
  EXPECT_LT(at_256, 0.03 * independent(256));
  EXPECT_LT(at_256, at_16 * std::pow(16.0, -1.35));

  // A discontinuity across the square: n^-0.75.
  const auto edge = [](const V2f& u) { return u.x * 1.3f + u.y < 0.9f ? 1.0 : 0.0; };
  const double area = 0.9 * 0.9 / 1.3 / 2;
  const double edge_error =
      rms_error(256, area, [&](uint32_t pixel, uint32_t s) { return edge(draw2d(9, pixel, 1, s, 0)); });
  const double edge_random = rms_error(256, area, [&](uint32_t, uint32_t) { return edge(random.unit2()); });
  EXPECT_LT(edge_error, 0.4 * edge_random);
}

TEST(SampleStream, EveryNumberIsUniformOverPixels) {
  std::vector<double> observed(1000, 0.0);
  for (uint32_t pixel = 0; pixel < 100000; ++pixel) {
    SampleStream stream(123, pixel % 317, pixel / 317, pixel % 5);
    stream.seek(pixel % 3);
    const float u = stream.next1d();
    ASSERT_GE(u, 0.0f);
    ASSERT_LT(u, 1.0f);
    observed[static_cast<int>(u * 1000)] += 1;
  }
  EXPECT_GT(chi_square(observed, std::vector<double>(1000, 100.0)).p, 1e-4);
}

}  // namespace
}  // namespace pelage
