// SPDX-License-Identifier: Apache-2.0
#include "render/light/light_set.h"

#include <numeric>

#include <gtest/gtest.h>

#include "render/light/environment_light.h"
#include "render/light/rectangle_light.h"
#include "render/light/sphere_light.h"
#include "tests/render/random.h"
#include "tests/support/chi_square.h"

namespace pelage {
namespace {

/// Spheres, rectangles that shine down from above, and a dim sky.
LightSet many_lights(int count) {
  std::vector<std::unique_ptr<Light>> lights;
  TestRandom random(count);
  for (int i = 0; i < count - 1; ++i) {
    const V3f at = random.direction() * random.between(3, 8);
    const Rgb radiance(std::pow(10.0f, random.between(-1, 2)));
    if (i % 2) {
      lights.push_back(std::make_unique<SphereLight>("s", at, random.between(0.1f, 1), radiance, false));
    } else {
      Rectangle shape;  // toward -z
      shape.center = at;
      shape.x = {-1, 0, 0};
      lights.push_back(std::make_unique<RectangleLight>("r", shape, radiance, false, false));
    }
  }
  lights.push_back(std::make_unique<EnvironmentLight>("sky", Rgb(0.1f), true));
  return LightSet(std::move(lights));
}

std::vector<float> probabilities(const LightSet& set, const V3f& from) {
  std::vector<float> p(set.size());
  set.probabilities(from, p);
  return p;
}

TEST(LightSet, ProbabilitiesSumToOneAndGiveUsefulLightsTheirShare) {
  for (int count : {1, 3, 10, 40}) {
    const LightSet set = many_lights(count);
    TestRandom random(2);
    for (int i = 0; i < 300; ++i) {
      const V3f from = random.direction() * random.between(0, 6);
      const std::vector<float> p = probabilities(set, from);
      ASSERT_NEAR(std::accumulate(p.begin(), p.end(), 0.0), 1, 1e-5);
      for (size_t k = 0; k < p.size(); ++k) {
        const bool useful = set.light(k).importance(from) > 0;
        ASSERT_EQ(p[k] > 0, useful);
        if (useful) {
          ASSERT_GE(p[k], 0.0999f / static_cast<float>(set.size()));
        }
        ASSERT_EQ(set.light(k).sample(from, V2f(0.4f)).has_value(), useful);
      }
    }
  }
}

TEST(LightSet, LightsThatLobesPointAtAreChosenMoreOften) {
  const LightSet set = many_lights(10);
  TestRandom random(5);
  std::vector<float> aimed(set.size());
  for (int i = 0; i < 300; ++i) {
    const V3f from = random.direction() * random.between(0, 2);
    const V3f aim = (set.light(size_t(i) % 9).ball()->center - from).normalized();
    // All of what is scattered goes into a cone of 0.2 rad about `aim`.
    const auto lobe = [&](const V3f& wi) {
      return wi.dot(aim) > std::cos(0.2f) ? 1 / (2 * kPi * (1 - std::cos(0.2f))) : 0;
    };
    const std::vector<float> plain = probabilities(set, from);
    set.probabilities(from, lobe, aimed);
    ASSERT_NEAR(std::accumulate(aimed.begin(), aimed.end(), 0.0), 1, 1e-5);
    const size_t at = size_t(i) % 9;
    if (plain[at] > 0 && plain[at] < 0.9f) {
      ASSERT_GT(aimed[at], plain[at]);
    }
    for (size_t k = 0; k < set.size(); ++k) ASSERT_EQ(aimed[k] > 0, plain[k] > 0);
  }
}

/// Fibres that are seen at a slant scatter along themselves as brightly as across: lobes say how much, no
/// cosine does.
TEST(LightSet, LightsAlongAFibreCountByItsLobes) {
  std::vector<std::unique_ptr<Light>> lights;
  for (const V3f& at : {V3f(0, 0, 5), V3f(5, 0, 0), V3f(0, 3, 4)}) {
    lights.push_back(std::make_unique<SphereLight>("s", at, 0.2f, Rgb(1), false));
  }
  const LightSet set(std::move(lights));
  std::vector<float> even(3), along(3);
  set.probabilities(
      V3f(0), [](const V3f&) { return 0.25f / kPi; }, even);
  for (const float p : even) EXPECT_NEAR(p, 1.0f / 3, 1e-6);
  // A lobe about the tangent z, as R, TT and TRT are seen from along the fibre.
  set.probabilities(
      V3f(0), [](const V3f& wi) { return wi.z > 0.9f ? 1 / (2 * kPi * 0.1f) : 0; }, along);
  EXPECT_GT(along[0], 0.75f);
  EXPECT_NEAR(along[1], along[2], 1e-6);
}

TEST(LightSet, ChoosesInProportion) {
  const LightSet set = many_lights(12);
  const std::vector<float> p = probabilities(set, V3f(0.3f, -0.2f, 0.5f));
  constexpr int kSamples = 200000;
  std::vector<double> observed(12, 0.0), expected(12);
  RunningMean remapped;
  TestRandom random(3);
  for (int i = 0; i < kSamples; ++i) {
    const LightSet::Choice choice = LightSet::choose(p, random.unit());
    ASSERT_EQ(choice.probability, p[choice.light]);
    ASSERT_GE(choice.remapped, 0.0f);
    ASSERT_LT(choice.remapped, 1.0f);
    observed[choice.light] += 1;
    remapped.add(choice.remapped);
  }
  for (size_t k = 0; k < 12; ++k) expected[k] = kSamples * p[k];
  EXPECT_GT(chi_square(observed, expected).p, 1e-4);
  EXPECT_NEAR(remapped.mean(), 0.5, 4 * remapped.standard_error());
  EXPECT_NEAR(remapped.variance(), 1.0 / 12, 2e-3);
}

TEST(LightSet, EvenlySpacedNumbersMakeASystematicSample) {
  const LightSet set = many_lights(12);
  const std::vector<float> p = probabilities(set, V3f(0.3f, -0.2f, 0.5f));
  constexpr int kDraws = 32;
  TestRandom random(4);
  for (int trial = 0; trial < 200; ++trial) {
    std::vector<int> hits(12, 0);
    const float offset = random.unit();
    for (int i = 0; i < kDraws; ++i) ++hits[LightSet::choose(p, (i + offset) / kDraws).light];
    for (size_t k = 0; k < 12; ++k) {
      ASSERT_LT(std::abs(hits[k] - kDraws * p[k]), 1.001);
    }
  }
}

TEST(LightSet, NothingToChooseFrom) {
  EXPECT_EQ(LightSet::choose(probabilities(LightSet({}), V3f(0)), 0.5f).probability, 0);
  std::vector<std::unique_ptr<Light>> lights;
  lights.push_back(std::make_unique<RectangleLight>("r", Rectangle{}, Rgb(1), false, false));  // toward +z
  lights.push_back(std::make_unique<EnvironmentLight>("night", Rgb(0), false));
  const LightSet dark(std::move(lights));
  EXPECT_EQ(LightSet::choose(probabilities(dark, V3f(0, 0, -1)), 0.5f).probability, 0);
  EXPECT_EQ(probabilities(dark, V3f(0, 0, -1))[0], 0);
  EXPECT_EQ(LightSet::choose(probabilities(dark, V3f(0, 0, 1)), 0.99f).probability, 1);
}

}  // namespace
}  // namespace pelage
