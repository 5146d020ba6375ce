// SPDX-License-Identifier: Apache-2.0
#include <gtest/gtest.h>

#include "post/motion_blur.h"
#include "tests/post/picture.h"

namespace pelage {
namespace {

TEST(MatteBlur, RankedMattesAreAveragedByIdAndRankedAgain) {
  Picture p(32, 4);
  std::vector<float> id(p.color.size()), coverage(p.color.size(), 1), id_out(id), coverage_out(id), id2(id),
      c2(id), id2_out(id), c2_out(id);
  p.each([&](int x, int, size_t i) {
    id[i] = x < 16 ? 7.0f : 9.0f;
    p.motion[i] = {8, 0};
  });
  const Workers workers(1);
  const FlowField field(p.width, p.height, p.motion, p.depth, LinkLimits(), workers);
  PostLayers layers;
  const auto plane = [&](std::vector<float>& v) { return Plane{v.data(), 1, p.width, 0}; };
  layers.channels = {{LayerRole::kMatte, plane(id), plane(id_out)},
                     {LayerRole::kMatte, plane(coverage), plane(coverage_out)},
                     {LayerRole::kMatte, plane(id2), plane(id2_out)},
                     {LayerRole::kMatte, plane(c2), plane(c2_out)}};
  layers.mattes = {{{{0, 1}, {2, 3}}}};
  NoProgress progress;
  blur_rows({&field, {4, 0, 0}, shutter_times({1, 0, 16}, 1), p.width, 0, p.height}, layers, {}, workers,
            progress);
  EXPECT_EQ(id_out[8], 7.0f);
  EXPECT_EQ(coverage_out[8], 1.0f);
  for (int x = 13; x < 19; ++x) {
    const size_t i = p.at(x, 2);
    EXPECT_EQ(id_out[i], x < 16 ? 7.0f : 9.0f) << x;
    EXPECT_EQ(id2_out[i], x < 16 ? 9.0f : 7.0f) << x;
    EXPECT_NEAR(coverage_out[i] + c2_out[i], 1, 1e-6) << x;
    EXPECT_GT(coverage_out[i], c2_out[i]);
    EXPECT_GT(c2_out[i], 0);
  }
}

}  // namespace
}  // namespace pelage
