// SPDX-License-Identifier: Apache-2.0
#include "world/sway.h"

#include <algorithm>
#include <cmath>
#include <memory>
#include <numbers>
#include <vector>

#include <gtest/gtest.h>

#include "groom/groom.h"
#include "groom/operators/follow.h"
#include "groom/sim/rod.h"
#include "tests/support/quiet_job.h"
#include "tests/world/small_scene.h"

namespace pelage {
namespace {

constexpr double kFrequency = 4, kDamping = 0.2, kFps = 24;

/// A cube with hair, twice as large as its file, that walks 2 units per frame along x from frame 1 to 3.
class SwayTest : public testing::Test {
 protected:
  SwayTest()
      : scene_(load_scene(files_.path("scene.yaml"),
                          {{"grooms.coat.dynamics",
                            "{mode: kinematic, guides: 9, sway_frequency: 4, sway_damping: 0.2}"}})),
        assets_(load_assets(scene_, job_)),
        groom_(*assets_->grooms.at("coat")),
        characters_(frame_characters(scene_, *assets_)),
        sway_(scene_, *assets_, characters_[0], 0, groom_, *scene_.grooms.find("coat")->value.dynamics) {}

  static double place(double frame) { return 2 * std::clamp(frame, 1.0, 3.0); }
  /// Lag of all tips along x: the sum of the free vibrations that each change of velocity has started.
  static double lag(int half) {
    const double step = 0.5 / kFps, omega = 2 * std::numbers::pi * kFrequency;
    const double quiet = omega * std::sqrt(1 - kDamping * kDamping);
    const int history = static_cast<int>(std::ceil(-std::log(0.01) / (kDamping * omega * step)));
    double sum = 0;
    for (int k = 1; k <= history; ++k) {
      const double at = 0.5 * (half - k);
      const double velocity_change = (place(at + 0.5) - 2 * place(at) + place(at - 0.5)) / step;
      const double fade = 1 - std::pow(static_cast<double>(k) / (history + 1), 4);
      sum -= velocity_change * fade * std::exp(-kDamping * omega * k * step) * std::sin(quiet * k * step) /
             quiet;
    }
    return sum;
  }

  const SmallScene files_;
  QuietJob job_{1};
  const SceneDescription scene_;
  const std::unique_ptr<Assets> assets_;
  const Groom& groom_;
  const std::vector<FrameCharacter> characters_;
  Sway sway_;
};

TEST_F(SwayTest, TipsLagBehindByTheSumOfAllVibrations) {
  const MovingGuides& guides = *groom_.guides();
  const auto segments = static_cast<size_t>(groom_.points() - 1);
  ASSERT_EQ(guides.follicles.size(), 9u);
  double greatest = 0;
  for (const int half : {4, 1, 3, 5, 6, 9, 30}) {  // in any order
    const GuideTurns turns = sway_.at(half);
    ASSERT_EQ(turns.size(), 4 * segments * guides.follicles.size());
    for (size_t g = 0; g < guides.follicles.size(); ++g) {
      const V3d along = 2.0 * V3d(guides.tips[g]);
      const double max = 0.9 * along.length(), behind = std::clamp(lag(half), -max, max);
      greatest = std::max(greatest, std::abs(behind));
      const Imath::Quatd full = smallest_turn(along.normalized(), (along + V3d(behind, 0, 0)).normalized());
      // The last segment is turned by the whole angle.
      const float* q = &turns[4 * (segments * g + segments - 1)];
      EXPECT_NEAR(q[3], full.r, 1e-5) << half << ' ' << g;
      EXPECT_LT((V3d(q[0], q[1], q[2]) - full.v).length(), 1e-5) << half << ' ' << g;
    }
  }
  EXPECT_GT(greatest, 0.05);
}

TEST_F(SwayTest, DependsOnNoOtherTime) {
  const GuideTurns first = sway_.at(5);
  sway_.at(4);
  sway_.at(8);
  EXPECT_EQ(sway_.at(5), first);
}

}  // namespace
}  // namespace pelage
