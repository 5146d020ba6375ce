// SPDX-License-Identifier: Apache-2.0
#include "render/frame/visibility_table.h"

#include <cmath>
#include <functional>

#include <gtest/gtest.h>

#include "image/texture_library.h"
#include "render/light/direct_light.h"
#include "render/light/light_params.h"

namespace pelage {
namespace {

/// A light of 2 x 2 at height 2 above a diffuse surface, of which only a part is visible: a spike that a few
/// pilot rays often miss.
class SpikyLight {
 public:
  using Visible = std::function<bool(const V2f& on_light)>;  // in [-1, 1]

  explicit SpikyLight(Visible visible)
      : visible_(std::move(visible)),
        textures_(ledger_),
        lights_(make()),
        direct_(lights_, 1, DirectTechniques::kLightsOnly),
        pilot_(lights_, 4, DirectTechniques::kLightsOnly) {}

  /// Means and standard errors of the light over independent runs, each with a table of its own.
  struct Estimate {
    double mean = 0, error = 0, arrived = 0;
  };
  Estimate estimate(LearnedUse use, uint32_t runs) const {
    double sum = 0, squares = 0;
    Estimate result;
    for (uint32_t run = 0; run < runs; ++run) {
      VisibilityTable table(LodView{}, 1);
      ScatterPoint point(V3f(0), V3f(0), LambertBsdf(Rgb(0.5f), V3f(0, 1, 0)));
      if (use != LearnedUse::kOff) {
        learn(point, run, table);
        table.freeze(use);
        point.set_learned(table.find(point.position(), false));
      }
      const double light = shade(point, run, result.arrived);
      sum += light;
      squares += light * light;
    }
    result.mean = sum / runs;
    result.error = std::sqrt((squares / runs - result.mean * result.mean) / runs);
    result.arrived /= runs;
    return result;
  }

 private:
  std::vector<std::unique_ptr<Light>> make() {
    RectangleLightParams params;
    params.position = V3f(0, 2, 0);
    params.look_at = V3f(0, 0, 0.001f);
    params.size = V2f(2, 2);
    params.radiance = Rgb(1);
    std::vector<std::unique_ptr<Light>> lights;
    lights.push_back(make_light("key", LightParams(params), 1, textures_, ledger_));
    return lights;
  }
  float through(const LightPoint& to) const {
    const V3f at = to.distance * to.direction;
    return visible_({at.x, at.z}) ? 1.0f : 0.0f;
  }
  static float no_lobes(const FibreValue&) { return 0; }

  /// 16 pilot rays.
  void learn(const ScatterPoint& point, uint32_t run, VisibilityTable& table) const {
    SampleStream stream(random_use("pilots"), run, 0, 0);
    DirectLightScratch scratch;
    pilot_.begin(point, scratch);
    pilot_.propose(point, stream.next2d(), no_lobes, scratch);
    for (const LightPoint& to : scratch.points)
      table.add(table.key(point.position(), false), to.light, to.stratum, through(to));
  }
  double shade(const ScatterPoint& point, uint32_t run, double& arrived) const {
    SampleStream stream(random_use("shading"), run, 0, 0);
    DirectLightScratch scratch;
    direct_.begin(point, scratch);
    direct_.propose(point, stream.next2d(), no_lobes, scratch);
    double light = 0;
    direct_.choose(1, stream.next1d(), scratch, [&](const LightPoint& to, float factor) {
      arrived += through(to);
      light += double{to.luminance} * factor * through(to);
    });
    return light;
  }

  Visible visible_;
  MemoryLedger ledger_;
  TextureLibrary textures_;
  LightSet lights_;
  DirectLight direct_, pilot_;
};

constexpr uint32_t kRuns = 10000;
constexpr double kSigmas = 3.3;  // a false alarm in a thousand

/// A quarter of one stratum; a thin bar; a half.
const SpikyLight::Visible kSpikes[] = {
    [](const V2f& at) { return at.x > 0.1f && at.x < 0.35f && at.y > 0.1f && at.y < 0.35f; },
    [](const V2f& at) { return std::abs(at.x + 0.3f) < 0.03f; }, [](const V2f& at) { return at.x > 0; }};

TEST(VisibilityTable, KeepsTheMeanOfSpikes) {
  for (const auto& visible : kSpikes) {
    const SpikyLight light(visible);
    const auto plain = light.estimate(LearnedUse::kOff, 8 * kRuns);
    const auto learned = light.estimate(LearnedUse::kOn, kRuns);
    EXPECT_NEAR(learned.mean, plain.mean, kSigmas * std::hypot(plain.error, learned.error));
    // The bar is in every stratum of two columns, and most pilot rays miss it there too.
    if (&visible != &kSpikes[1]) {
      EXPECT_GT(learned.arrived, 1.05 * plain.arrived);
    }
  }
}

// The guard of the test above: it must see the bias of the rule that lost light stays lost.
TEST(VisibilityTable, RejectionLosesSpikes) {
  for (const size_t spike : {size_t(0), size_t(1)}) {
    const SpikyLight light(kSpikes[spike]);
    const auto plain = light.estimate(LearnedUse::kOff, 8 * kRuns);
    const auto rejected = light.estimate(LearnedUse::kReject, kRuns);
    EXPECT_LT(rejected.mean, plain.mean - 2 * kSigmas * std::hypot(plain.error, rejected.error));
  }
}

TEST(VisibilityTable, NoFactorIsZeroUnlessRejected) {
  VisibilityTable table(LodView{}, 2), rejecting(LodView{}, 2);
  for (VisibilityTable* each : {&table, &rejecting}) {
    for (uint32_t stratum = 0; stratum < LearnedVisibility::kStrata; ++stratum) {
      for (int i = 0; i < 50; ++i) each->add(each->key(V3f(1), true), 0, stratum, 0);
      each->add(each->key(V3f(1), true), 1, stratum, 1);
    }
  }
  table.freeze(LearnedUse::kOn);
  rejecting.freeze(LearnedUse::kReject);
  const LearnedVisibility learned = table.find(V3f(1), true), rejected = rejecting.find(V3f(1), true);
  for (uint32_t stratum = 0; stratum < LearnedVisibility::kStrata; ++stratum) {
    EXPECT_GE(learned.factor(0, stratum), 0.99f * VisibilityTable::kDefensive);
    EXPECT_LT(learned.factor(0, stratum), 0.4f);
    EXPECT_GT(learned.factor(1, stratum), 0.8f);
    EXPECT_EQ(rejected.factor(0, stratum), 0);
    EXPECT_EQ(rejected.factor(1, stratum), 1);
  }
  EXPECT_EQ(table.find(V3f(1), false).factor(0, 0), 1) << "an unknown cell";
  EXPECT_EQ(table.cells(), 1u);
}

}  // namespace
}  // namespace pelage
