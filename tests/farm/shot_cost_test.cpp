// SPDX-License-Identifier: Apache-2.0
#include "farm/shot_cost.h"

#include <gtest/gtest.h>

namespace pelage {
namespace {

TEST(ShotCost, EstimatesTheFirstTheMiddleAndTheLastFrame) {
  EXPECT_EQ(frames_to_estimate({1, 2, 3, 4, 9}), (std::vector<int>{1, 3, 9}));
  EXPECT_EQ(frames_to_estimate({1, 2}), (std::vector<int>{1, 2}));
  EXPECT_EQ(frames_to_estimate({7}), (std::vector<int>{7}));
}

TEST(ShotCost, EachRegionRepeatsWhatNoCacheHas) {
  FarmRequest request;
  request.frames = {1, 2, 3, 4};
  request.width = request.height = 64;
  request.columns = 2;
  RunEstimate estimate;
  estimate.frames = {1, 4};
  estimate.loading_cpu_s = 10;
  estimate.posing_cpu_s = 2;
  FrameEstimate frame;
  frame.measuring_cpu_s = 20;
  frame.growing_cpu_s = 60;
  frame.tracing_cpu_s = 1000;
  estimate.estimates = {frame, frame};
  const ShotCost cost = shot_cost(request, estimate, false);
  EXPECT_DOUBLE_EQ(cost.whole_s, 4 * (10 + 1 + 20 + 60 + 1000));
  EXPECT_DOUBLE_EQ(cost.repeated_s, 4 * (10 + 1 + 20 + 60));
  request.grows = true;  // boxes are shared, and fur is read in a sixth of the time
  EXPECT_DOUBLE_EQ(shot_cost(request, estimate, true).repeated_s, 4 * (10 + 1 + 10));
  request.columns = 1;
  EXPECT_EQ(shot_cost(request, estimate, false).repeated_s, 0);
}

TEST(ShotCost, ReservesMoreThanTheEstimate) {
  RunEstimate estimate;
  estimate.frames = {1, 2};
  estimate.estimates.resize(2);
  estimate.estimates[1].scene_bytes = 1000;
  EXPECT_EQ(reserved_bytes(estimate),
            static_cast<uint64_t>(1.2 * double(estimate.estimates[1].peak_bytes())));
}

}  // namespace
}  // namespace pelage
