// SPDX-License-Identifier: Apache-2.0
#include "render/light/environment_light.h"

#include <gtest/gtest.h>

#include "base/error.h"
#include "render/light/guided_cdf.h"
#include "tests/render/random.h"
#include "tests/render/sphere_statistics.h"
#include "tests/support/effort.h"

namespace pelage::environment_light_test {
namespace {

constexpr double kPiD = std::numbers::pi;

Image make_image(int width, int height, float value = 0) {
  Image image{width, height, 3, {}};
  image.pixels.assign(static_cast<size_t>(width) * height * 3, value);
  return image;
}

/// Most texels black, the rest over four orders of magnitude.
Image speckled(int width, int height) {
  Image image = make_image(width, height);
  TestRandom random(40);
  for (float& v : image.pixels) v = random.unit() < 0.5f ? 0.0f : std::pow(10.0f, random.between(-3, 1));
  return image;
}

TEST(GuidedCdf, DrawsEveryEntryInProportion) {
  for (size_t count : {1, 2, 15, 16, 17, 100, 1000}) {
    std::vector<float> weights(count), cdf;
    TestRandom random(count);
    for (float& w : weights) w = random.unit() < 0.3f ? 0.0f : random.unit();
    weights[count / 2] = 3;
    cdf = weights;
    std::vector<uint32_t> guide(guide_size(count));
    const double total = make_guided_cdf(cdf, guide);
    EXPECT_EQ(cdf.back(), 1.0f);
    // The truth: a linear search for the first entry whose sum exceeds u.
    const auto compare = [&](float u) {
      size_t slow = 0;
      while (cdf[slow] <= u) ++slow;
      const GuidedSample draw = sample_guided(cdf, guide, u);
      ASSERT_EQ(draw.index, slow) << u << " of " << count;
      ASSERT_GT(weights[slow], 0.0f);
      ASSERT_GE(draw.rest, 0.0f);
      ASSERT_LT(draw.rest, 1.0f);
    };
    std::vector<double> observed(count, 0.0), expected(count);
    for (int i = 0; i < 20000; ++i) {
      const float u = random.unit();
      compare(u);
      observed[sample_guided(cdf, guide, u).index] += 1;
    }
    for (float edge : cdf) {
      if (edge < 1) compare(edge), compare(std::nextafter(edge, 0.0f)), compare(std::nextafter(edge, 1.0f));
    }
    compare(0.0f);
    compare(kBelowOne);
    for (size_t i = 0; i < count; ++i) expected[i] = 20000 * weights[i] / total;
    EXPECT_GT(chi_square(observed, expected).p, 1e-4) << count;
  }
}

TEST(GuidedCdf, NothingButZerosIsUniform) {
  std::vector<float> cdf(4, 0.0f);
  std::vector<uint32_t> guide(guide_size(4));
  EXPECT_EQ(make_guided_cdf(cdf, guide), 0);
  EXPECT_EQ(cdf, (std::vector<float>{0.25f, 0.5f, 0.75f, 1}));
}

std::shared_ptr<const Texture> textured(const Image& image) { return std::make_shared<const Texture>(image); }

TEST(EnvironmentMap, IsOrientedAsStated) {
  Image image = make_image(8, 4, 1);
  const EnvironmentMap map(textured(image), Rgb(1));
  const auto texel = [&](V3f w) { return map.texel_of(w.normalized()); };
  EXPECT_EQ(texel({0, 1, 0}).y, 0);
  EXPECT_EQ(texel({0, -1, 0}).y, 3);
  EXPECT_EQ(texel({0.01f, 0.01f, -1}).x, 4) << "the centre column looks along -z";
  EXPECT_EQ(texel({-0.01f, 0.01f, -1}).x, 3);
  EXPECT_EQ(texel({1, 0.01f, -0.01f}).x, 5) << "+x is to its right";
  EXPECT_EQ(texel({0.01f, 0.01f, 1}).x, 7);
  EXPECT_EQ(texel({-0.01f, 0.01f, 1}).x, 0);
}

TEST(EnvironmentMap, DrawsTexelsInProportionUniformlyInside) {
  const Image image = speckled(40, 24);
  const EnvironmentMap map(textured(image), Rgb(1, 2, 0.5f));
  // Counts by texel and quarter of texel.
  std::vector<double> observed(40 * 24 * 4, 0.0), expected(40 * 24 * 4, 0.0);
  TestRandom random(2);
  constexpr int kSamples = static_cast<int>(repetitions(400000));
  int astray = 0;
  for (int i = 0; i < kSamples; ++i) {
    const EnvironmentMap::Sample sample = map.sample(random.unit2());
    const EnvironmentMap::Texel found = map.texel_of(sample.direction);
    astray += found.x != sample.texel.x || found.y != sample.texel.y;
    const double top = std::cos(kPiD * sample.texel.y / 24),
                 bottom = std::cos(kPiD * (sample.texel.y + 1) / 24);
    const double turn = std::atan2(sample.direction.x, -sample.direction.z) / (2 * kPiD) + 0.5;
    const int right = turn * 40 - sample.texel.x > 0.5;
    const int low = (sample.direction.y - top) / (bottom - top) > 0.5;
    observed[(sample.texel.y * 40 + sample.texel.x) * 4 + 2 * low + right] += 1;
  }
  double sum = 0;
  for (int y = 0; y < 24; ++y) {
    for (int x = 0; x < 40; ++x) {
      const double share = map.pdf({x, y}) * map.texel_solid_angle(y);
      sum += share;
      for (int part = 0; part < 4; ++part) expected[(y * 40 + x) * 4 + part] = kSamples * share / 4;
      const float* p = image.at(x, y);
      EXPECT_EQ(map.pdf({x, y}) > 0, p[0] + p[1] + p[2] > 0);
    }
  }
  EXPECT_NEAR(sum, 1, 1e-5);
  EXPECT_LE(astray, 20) << "directions that rounding carried into a neighbour";
  const ChiSquare test = chi_square(observed, expected);
  EXPECT_GT(test.p, 1e-4) << test.statistic << " / " << test.dof;
  EXPECT_EQ(test.impossible, 0);
}

TEST(EnvironmentMap, TexelSolidAnglesCoverTheSphere) {
  const Image image = make_image(37, 19, 1);
  const EnvironmentMap map(textured(image), Rgb(1));
  double sum = 0;
  for (int y = 0; y < 19; ++y) sum += 37 * map.texel_solid_angle(y);
  EXPECT_NEAR(sum, 4 * kPiD, 1e-12);
  EXPECT_NEAR(map.power(), 4 * kPiD, 1e-5);
}

TEST(EnvironmentMap, SingleTexelsAreFoundEvenAtThePoles) {
  for (int row : {0, 16, 31}) {
    Image image = make_image(64, 32);
    image.at(10, row)[1] = 5000;
    const EnvironmentMap map(textured(image), Rgb(1));
    TestRandom random(3);
    for (int i = 0; i < 2000; ++i) {
      const EnvironmentMap::Sample sample = map.sample(random.unit2());
      ASSERT_EQ(sample.texel.x, 10);
      ASSERT_EQ(sample.texel.y, row);
    }
    EXPECT_NEAR(map.pdf({10, row}) * map.texel_solid_angle(row), 1, 1e-6);
    EXPECT_EQ(map.pdf({11, row}), 0);
  }
}

// Of images with more texels than a map has cells, the same must hold as of others: the density is that of a
// distribution of texels, and samples follow it.
TEST(EnvironmentMap, CellsOfManyTexelsChangeNoDensity) {
  Image image = speckled(53, 29);  // cells at the edges are cut off
  image.at(17, 3)[1] = 4000;       // a sun
  const auto texture = textured(image);
  const EnvironmentMap full(texture, Rgb(1, 2, 0.5f));
  for (int64_t cells : {800, 100, 9, 1}) {
    const EnvironmentMap map(texture, Rgb(1, 2, 0.5f), {}, cells);
    EXPECT_LT(map.bytes(), full.bytes());
    EXPECT_NEAR(map.power() / full.power(), 1, 1e-6);
    TestRandom random(11);
    constexpr int kCount = static_cast<int>(repetitions(200000));
    std::vector<int> drawn(static_cast<size_t>(image.width * image.height));
    int different = 0;
    for (int i = 0; i < kCount; ++i) {
      const EnvironmentMap::Sample sample = map.sample(random.unit2());
      ASSERT_GT(map.pdf(sample.texel), 0);
      ASSERT_NEAR(map.pdf(sample.texel) / full.pdf(sample.texel), 1, 1e-5);
      ++drawn[static_cast<size_t>(sample.texel.y * image.width + sample.texel.x)];
      const EnvironmentMap::Texel found = map.texel_of(sample.direction);
      different += found.x != sample.texel.x || found.y != sample.texel.y;
    }
    EXPECT_LE(different, 40) << "rounding at edges of texels only";
    double chi = 0;
    int dof = -1;
    for (int y = 0; y < image.height; ++y) {
      for (int x = 0; x < image.width; ++x) {
        const double expected = full.pdf({x, y}) * full.texel_solid_angle(y) * kCount;
        const int count = drawn[static_cast<size_t>(y * image.width + x)];
        if (expected < 5) continue;
        chi += (count - expected) * (count - expected) / expected;
        ++dof;
      }
    }
    ASSERT_GT(dof, 50);
    // Five standard deviations of the distribution of chi-square.
    EXPECT_LT(chi, dof + 5 * std::sqrt(2.0 * dof)) << cells;
  }
}

TEST(EnvironmentMap, StopsWhileItIsMade) {
  int calls = 0;
  const auto stop = [&] {
    if (++calls == 3) throw Error(ErrorKind::kStopped, "stop");
  };
  EXPECT_THROW(EnvironmentMap(textured(speckled(300, 200)), Rgb(1), stop), Error);
  EXPECT_EQ(calls, 3);
}

TEST(EnvironmentLight, RefusesADistributionThatDoesNotFit) {
  MemoryLedger ledger;
  ledger.set_limit(1000);
  try {
    EnvironmentLight("sky", textured(speckled(64, 32)), Rgb(1), M33f(), true, ledger);
    FAIL() << "accepted";
  } catch (const Error& error) {
    EXPECT_EQ(error.kind(), ErrorKind::kMemory);
    EXPECT_EQ(std::string(error.what()).find("sampling light 'sky' (64 x 32 texels) needs "), 0u)
        << error.what();
  }
  EXPECT_EQ(ledger.current(MemoryTag::kTextures), 0);
}

TEST(EnvironmentLight, SamplesCarryTheWholePower) {
  MemoryLedger ledger;
  const auto texture = std::make_shared<const Texture>(speckled(64, 32));
  const EnvironmentLight light("sky", texture, Rgb(0.5f), rotation_xyz({20, 130, -40}), true, ledger);
  EXPECT_GT(ledger.current(MemoryTag::kTextures), 64 * 32 * 4);
  const EnvironmentMap map(texture, Rgb(0.5f));
  TestRandom random(8);
  int different = 0;
  for (int i = 0; i < 20000; ++i) {
    const std::optional<LightSample> s = light.sample(V3f(0), random.unit2());
    ASSERT_TRUE(s);
    // Proportional to luminance: every sample carries the same.
    ASSERT_NEAR(luminance(s->radiance) / s->pdf / map.power(), 1, 1e-5);
    different += light.pdf(V3f(0), s->direction) != s->pdf ||
                 light.intersect(V3f(0), s->direction)->radiance != s->radiance;
  }
  EXPECT_LE(different, 4) << "rounding at edges of texels only";
  EXPECT_NEAR(light.importance(V3f(0)) / map.power(), 1, 1e-6);
  const SphereGrid grid(V3f(0, 1, 0));
  EXPECT_NEAR(sphere_integral(grid, [&](const V3f& w) { return light.pdf(V3f(0), w); }), 1, 5e-3);
}

TEST(EnvironmentLight, PassesChiSquareWhenRotated) {
  MemoryLedger ledger;
  const EnvironmentLight light("sky", std::make_shared<const Texture>(speckled(20, 10)), Rgb(1),
                               rotation_xyz({-30, 70, 15}), true, ledger);
  TestRandom random(9);
  const ChiSquare test = sphere_chi_square(
      SphereGrid(V3f(0.36f, 0.48f, 0.8f)),
      [&](int) -> std::optional<V3f> { return light.sample(V3f(0), random.unit2())->direction; },
      [&](const V3f& w) { return light.pdf(V3f(0), w); });
  EXPECT_GT(test.p, 1e-4) << test.statistic << " / " << test.dof;
}

TEST(EnvironmentLight, RotatesAboutXThenYThenZ) {
  Image image = make_image(16, 8, 0.01f);
  image.at(8, 4)[0] = 100;  // just right of and below -z
  MemoryLedger ledger;
  const auto sun = [&](V3f degrees) {
    const EnvironmentLight light("sky", std::make_shared<const Texture>(image), Rgb(1), rotation_xyz(degrees),
                                 true, ledger);
    TestRandom random(1);
    V3f mean(0);
    for (int i = 0; i < 4000; ++i) {
      const std::optional<LightSample> s = light.sample(V3f(0), random.unit2());
      if (s->radiance.x > 1) mean += s->direction;
    }
    return mean.normalized();
  };
  const V3f at = sun(V3f(0));
  EXPECT_GT(at.dot(V3f(0, 0, -1)), 0.9f);
  const auto near = [](const V3f& a, const V3f& b) { return a.dot(b.normalized()) > 0.999f; };
  EXPECT_TRUE(near(sun({0, 90, 0}), V3f(at.z, at.y, -at.x)));               // y turns z into x
  EXPECT_TRUE(near(sun({90, 0, 0}), V3f(at.x, -at.z, at.y)));               // x turns y into z
  EXPECT_TRUE(near(sun({0, 0, 90}), V3f(-at.y, at.x, at.z)));               // z turns x into y
  const V3f tilted(at.x, -at.z, at.y);                                      // x first,
  EXPECT_TRUE(near(sun({90, 90, 0}), V3f(tilted.z, tilted.y, -tilted.x)));  // then y
}

TEST(EnvironmentLight, ConstantOnesNeedNoMap) {
  const EnvironmentLight light("sky", Rgb(0.3f), true);
  TestRandom random(10);
  V3f mean(0);
  for (int i = 0; i < 10000; ++i) {
    const std::optional<LightSample> s = light.sample(V3f(0), random.unit2());
    ASSERT_EQ(s->pdf, light.pdf(V3f(0), s->direction));
    ASSERT_FLOAT_EQ(s->pdf, 1 / (4 * kPi));
    ASSERT_EQ(s->radiance, Rgb(0.3f));
    ASSERT_EQ(light.intersect(V3f(0), s->direction)->radiance, Rgb(0.3f));
    mean += s->direction / 10000.0f;
  }
  EXPECT_LT(mean.length(), 0.02f);
  EXPECT_FLOAT_EQ(light.importance(V3f(0)), 4 * kPi * 0.3f);
  EXPECT_FALSE(EnvironmentLight("night", Rgb(0), true).sample(V3f(0), V2f(0.5f)));
}

TEST(EnvironmentLight, BlackNegativeAndBrokenImages) {
  MemoryLedger ledger;
  const auto light = [&](Image image) {
    return EnvironmentLight("sky", std::make_shared<const Texture>(std::move(image)), Rgb(1), M33f(), true,
                            ledger);
  };
  const EnvironmentLight black = light(make_image(4, 2));
  EXPECT_FALSE(black.sample(V3f(0), V2f(0.5f)));
  EXPECT_EQ(black.pdf(V3f(0), V3f(0, 0, 1)), 0);
  EXPECT_EQ(black.importance(V3f(0)), 0);

  Image ringing = make_image(4, 2, 1);
  ringing.at(2, 1)[0] = -3;
  const EnvironmentLight clamped = light(ringing);
  for (float turn = 0; turn < 1; turn += 0.01f) {
    EXPECT_GE(
        clamped.intersect(V3f(0), polar_direction({0, 0, 1}, {1, 0, 0}, {0, 1, 0}, -0.5f, turn))->radiance.x,
        0);
  }

  for (float bad : {std::numeric_limits<float>::infinity(), std::numeric_limits<float>::quiet_NaN()}) {
    Image broken = make_image(4, 2, 1);
    broken.at(3, 1)[2] = bad;
    try {
      light(broken);
      FAIL() << "accepted";
    } catch (const Error& error) {
      EXPECT_EQ(error.kind(), ErrorKind::kInput);
      EXPECT_NE(std::string(error.what()).find("pixel 3, 1"), std::string::npos) << error.what();
    }
  }
  EXPECT_THROW(light(Image{}), Error);
}

TEST(EnvironmentLight, OneChannelIsGrey) {
  Image image{4, 2, 1, std::vector<float>(8, 0.25f)};
  const EnvironmentMap map(textured(image), Rgb(1, 2, 4));
  EXPECT_EQ(map.radiance({1, 1}), Rgb(0.25f, 0.5f, 1));
}

}  // namespace
}  // namespace pelage::environment_light_test
