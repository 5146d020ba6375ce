// SPDX-License-Identifier: Apache-2.0
#include "render/light/light_tree.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <memory>
#include <set>
#include <vector>

#include <gtest/gtest.h>

#include "render/light/environment_light.h"
#include "render/light/light_set.h"
#include "render/light/rectangle_light.h"
#include "render/light/sphere_light.h"
#include "tests/render/random.h"

namespace pelage::light_tree_test {
namespace {

/// Spheres, rectangles that shine to one side, and two skies.
LightSet many_lights(int near) {
  std::vector<std::unique_ptr<Light>> lights;
  lights.push_back(std::make_unique<EnvironmentLight>("sky", Rgb(0.1f), true));
  TestRandom random(near);
  for (int i = 0; i < near; ++i) {
    const V3f at = random.direction() * random.between(3, 8);
    const Rgb radiance(std::pow(10.0f, random.between(-1, 2)));
    if (i % 2) {
      lights.push_back(std::make_unique<SphereLight>("s", at, random.between(0.1f, 1), radiance, true));
    } else {
      Rectangle shape;  // toward -z
      shape.center = at;
      shape.x = {-1, 0, 0};
      lights.push_back(std::make_unique<RectangleLight>("r", shape, radiance, false, true));
    }
  }
  lights.push_back(std::make_unique<EnvironmentLight>("stars", Rgb(0.01f), true));
  return LightSet(std::move(lights));
}

/// A lobe towards +x.
float lobe(const V3f& wi) { return std::max(wi.x, 0.0f) / kPi; }

LightChoices choices_at(const LightSet& set, const V3f& from) {
  LightChoices choices;
  set.prepare(from, lobe, choices);
  return choices;
}

TEST(LightTree, OnlyUsefulLightsHaveProbabilitiesAndFewAreLost) {
  for (const int near : {9, 10, 64, 300}) {
    const LightSet set = many_lights(near);
    TestRandom random(2);
    double mean = 0;
    for (int i = 0; i < 50; ++i) {
      const V3f from = random.direction() * random.between(0, 9);
      const LightChoices choices = choices_at(set, from);
      EXPECT_LE(choices.cut.size(), LightTree::kMaxCut);
      double sum = 0;
      for (size_t k = 0; k < set.size(); ++k) {
        const float p = set.probability(choices, k);
        ASSERT_EQ(p > 0, set.light(k).importance(from) > 0) << k;
        sum += p;
      }
      // A node whose lights all face away has an importance, but none of its lights is chosen.
      ASSERT_LE(sum, 1 + 1e-4);
      mean += sum / 50;
    }
    EXPECT_GT(mean, 0.8);
  }
}

TEST(LightTree, ChoosesLightsWithTheirProbabilities) {
  const LightSet set = many_lights(40);
  TestRandom random(4);
  LightChoices choices = choices_at(set, V3f(0.3f, -0.2f, 0.5f));
  constexpr int kDraws = 100'000;
  std::vector<double> counts(set.size() + 1), expected(set.size() + 1);
  std::vector<float> numbers(kDraws);
  for (float& number : numbers) number = random.unit();
  std::vector<LightSet::Choice> chosen(kDraws);
  set.choose(choices, numbers, chosen);
  for (int i = 0; i < kDraws; ++i) {
    const LightSet::Choice& choice = chosen[i];
    if (i % 1000 == 0) {
      LightSet::Choice alone;
      set.choose(choices, {&numbers[i], 1}, {&alone, 1});
      EXPECT_EQ(alone.light, choice.light);
      EXPECT_EQ(alone.remapped, choice.remapped);
    }
    ASSERT_GE(choice.remapped, 0);
    ASSERT_LT(choice.remapped, 1);
    if (choice.probability > 0) {
      ASSERT_NEAR(choice.probability / set.probability(choices, choice.light), 1, 1e-4);
    }
    ++counts[choice.probability > 0 ? choice.light : set.size()];
  }
  double rest = 1;
  for (size_t k = 0; k < set.size(); ++k) {
    expected[k] = kDraws * double{set.probability(choices, k)};
    rest -= expected[k] / kDraws;
  }
  expected.back() = kDraws * std::max(rest, 0.0);
  double chi2 = 0;
  int bins = -1;
  for (size_t k = 0; k < expected.size(); ++k) {
    if (expected[k] < 5) continue;
    chi2 += std::pow(counts[k] - expected[k], 2) / expected[k];
    ++bins;
  }
  EXPECT_GT(bins, 20);
  EXPECT_LT(chi2, bins + 5 * std::sqrt(2.0 * bins));  // 5 standard deviations: 1e-6 or less
}

TEST(LightTree, FindsAllLightsOnARay) {
  const LightSet set = many_lights(64);
  TestRandom random(3);
  size_t visits = 0, hits = 0;
  for (int i = 0; i < 3000; ++i) {
    const V3f from = random.direction() * random.between(0, 9), direction = random.direction();
    for (const float distance : {5.0f, std::numeric_limits<float>::infinity()}) {
      std::set<size_t> found;
      set.on_ray(from, direction, distance, [&](size_t light) {
        EXPECT_TRUE(found.insert(light).second);
        EXPECT_FALSE(std::isfinite(distance) && set.light(light).is_infinitely_far());
      });
      visits += found.size();
      for (size_t k = 0; k < set.size(); ++k) {
        if (set.light(k).is_infinitely_far() && std::isfinite(distance)) continue;
        if (!set.light(k).intersect(from, direction)) continue;
        ASSERT_EQ(found.count(k), 1u);
        ++hits;
      }
    }
  }
  EXPECT_LT(visits, 4 * hits) << "it visits few others";
}

TEST(LightTree, ALightThatLobesPointAtIsChosenMoreOften) {
  const LightSet set = many_lights(64);
  LightChoices plain;
  const V3f from(0.1f, 0.2f, 0.3f);
  set.prepare(
      from, [](const V3f&) { return 1 / (4 * kPi); }, plain);
  const LightChoices aimed = choices_at(set, from);
  double before = 0, after = 0;  // probability of the lights on the side of the lobe
  for (size_t k = 0; k < set.size(); ++k) {
    const auto ball = set.light(k).ball();
    if (!ball || ball->center.x < 1) continue;
    before += set.probability(plain, k);
    after += set.probability(aimed, k);
  }
  EXPECT_GT(after / (1 - after), 1.5 * before / (1 - before));
}

TEST(LightTree, GroupsAreFewAndContainAllLights) {
  const LightSet few = many_lights(8), many = many_lights(64);
  EXPECT_EQ(few.groups(), few.size());
  for (size_t k = 0; k < few.size(); ++k) EXPECT_EQ(few.group(k), k);
  EXPECT_EQ(many.groups(), 5u);
  std::vector<int> counts(many.groups());
  for (size_t k = 0; k < many.size(); ++k) ++counts.at(many.group(k));
  EXPECT_EQ(counts[0], 2) << "the skies";
  for (const int count : counts) EXPECT_GT(count, 0);
  EXPECT_EQ(many.group(0), many.group(many.size() - 1));
}

}  // namespace
}  // namespace pelage::light_tree_test
