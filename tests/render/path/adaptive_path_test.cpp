// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <cmath>

#include <gtest/gtest.h>

#include "render/render_frame.h"
#include "tests/render/film/film_picture.h"
#include "tests/render/path/lamp_scene.h"
#include "tests/support/effort.h"

namespace pelage {
namespace {

TEST(AdaptivePath, ThreadsMemoryAndPassesDoNotChangeThePicture) {
  LampScene scene;
  scene.render.samples = static_cast<int>(at_least(72, 300));
  const FrameResult one = scene.run({}, 1), many = scene.run({}, 4);
  const ExrImage a = picture_of(one.film), b = picture_of(many.film);
  ASSERT_EQ(a.channels.size(), b.channels.size());
  int named = 0;
  for (size_t i = 0; i < a.channels.size(); ++i) {
    EXPECT_EQ(a.channels[i].pixels, b.channels[i].pixels) << a.channels[i].name;
    EXPECT_EQ(a.channels[i].ids, b.channels[i].ids) << a.channels[i].name;
    named += a.channels[i].name == "samples" || a.channels[i].name == "noise";
  }
  EXPECT_EQ(named, 2);
  EXPECT_FALSE(one.time_limited);
}

TEST(AdaptivePath, ATimeLimitLeavesAWholePicture) {
  for (bool adaptive : {false, true}) {
    LampScene scene;
    scene.render.samples = 1 << 20;
    scene.render.adaptive->noise = 1e-4f;
    if (!adaptive) scene.render.adaptive.reset();
    scene.render.time_limit = 0.3f;
    const FrameResult result = scene.run();
    EXPECT_TRUE(result.time_limited);
    EXPECT_FALSE(result.partial);
    EXPECT_GE(result.samples, 1u);
    EXPECT_LT(result.mean_samples, 1 << 20);

    scene.render.time_limit = 1e-6f;
    EXPECT_EQ(scene.run().mean_samples, 1) << "one for every pixel, always";
    scene.render.time_limit = 1e6f;
    scene.render.samples = 4;
    EXPECT_FALSE(scene.run().time_limited);
  }
}

/// Records the reported progress.
class Bar final : public Progress {
 public:
  void begin(std::string_view, double total) override {
    done_ = 0;
    total_ = total;
  }
  void advance(double amount) override { done_ = done_ + amount; }
  void expect(double total) override { total_ = total; }
  void end() override { worst_ = std::max(worst_, std::abs(done_ - total_) / std::max(1.0, total_)); }
  bool cancelled() const override { return false; }
  double worst() const { return worst_; }

 private:
  double done_ = 0, total_ = 0, worst_ = 0;
};

TEST(AdaptivePath, TheProgressBarEndsFull) {
  for (NoiseGoal goal : {NoiseGoal::kFrame, NoiseGoal::kPixel}) {
    LampScene scene;
    scene.render.samples = static_cast<int>(at_least(48, 128));
    scene.render.adaptive->goal = goal;
    Bar bar;
    scene.run({}, 1, bar);
    EXPECT_LT(bar.worst(), 1e-6);
  }
}

}  // namespace
}  // namespace pelage
