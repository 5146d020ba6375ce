// SPDX-License-Identifier: Apache-2.0
#include "post/stereo.h"

#include <gtest/gtest.h>

#include "tests/post/picture.h"

namespace pelage {
namespace {

TEST(Stereo, NoParallaxIsTheIdentityThroughTheBox) {
  const Picture p(70, 20);
  for (int scale : {1, 4, 6}) {
    StereoSetup setup;
    setup.scale = scale;
    setup.filter = StereoFilter::kBox;
    const Result result = other_eye(p, setup);
    EXPECT_EQ(bits(result.color), bits(p.color));
    EXPECT_EQ(bits(result.data), bits(p.data));
    for (float v : result.invented) ASSERT_EQ(v, 0);
    for (float v : result.missing) ASSERT_EQ(v, 0);
  }
}

TEST(Stereo, WhatConvergesStaysAndNearThingsMoveLeft) {
  const StereoCamera camera{1000, 0.5f, 10};
  EXPECT_EQ(parallax(camera, 10), 0);
  EXPECT_LT(parallax(camera, 5), 0);
  EXPECT_GT(parallax(camera, 20), 0);
  EXPECT_FLOAT_EQ(parallax(camera, std::numeric_limits<float>::infinity()), 50);
  EXPECT_FLOAT_EQ(parallax({1000, 0.5f}, 10), -50);  // parallel cameras
  EXPECT_FLOAT_EQ(parallax({1000, -0.5f, 10}, 5), -parallax(camera, 5));
}

/// A near bar before a far plane.
Picture two_planes(float near_shift, float far_shift) {
  Picture p(120, 12);
  p.each([&](int x, int, size_t i) {
    const bool near = x >= 50 && x < 70;
    p.depth[i] = near ? 2.0f : 8.0f;
    p.motion[i] = {near ? near_shift : far_shift, 0};
  });
  return p;
}

TEST(Stereo, AGapIsAsWideAsTheParallaxDiffers) {
  const float shifts[][2] = {{-7, 0}, {-9, 3}, {-6.4f, 1.3f}, {5, 0}, {-0.8f, 0}};
  for (const auto& s : shifts) {
    const Picture p = two_planes(s[0], s[1]);
    StereoSetup setup;
    const Result empty = other_eye(p, setup);
    setup.longest_fill = 30;
    const Result full = other_eye(p, setup);
    for (int y = 0; y < p.height; ++y) {
      float missing = 0, invented = 0;
      for (int x = 30; x < 90; ++x) {  // away from the sides of the picture
        missing += empty.missing[p.at(x, y)];
        invented += full.invented[p.at(x, y)];
        ASSERT_EQ(full.missing[p.at(x, y)], 0);
      }
      EXPECT_NEAR(missing, std::abs(s[0] - s[1]), 1.0f / setup.scale + 1e-5f) << s[0] << " " << s[1];
      EXPECT_EQ(invented, missing);
    }
  }
}

TEST(Stereo, GapsAreFilledFromBehind) {
  Picture p = two_planes(-9, 0);
  p.each([&](int x, int, size_t i) { p.color[i] = x >= 50 && x < 70 ? 1.0f : 0.25f; });
  StereoSetup setup;
  setup.longest_fill = 20;
  setup.filter = StereoFilter::kBox;
  const Result result = other_eye(p, setup);
  for (int x = 0; x < p.width; ++x) {
    EXPECT_EQ(result.color[p.at(x, 6)], x >= 41 && x < 61 ? 1.0f : 0.25f) << x;
    EXPECT_EQ(result.invented[p.at(x, 6)], x >= 61 && x < 70 ? 1.0f : 0.0f) << x;
  }
}

TEST(Stereo, NothingShinesThroughAGap) {
  // Two bars side by side come apart; what is clear, infinitely far away, moves the most and comes to lie
  // between them, where the bar behind goes on.
  Picture p(80, 6);
  p.each([&](int x, int, size_t i) {
    const bool near = x >= 20 && x < 30, far = x >= 30 && x < 40;
    p.color[i] = near ? 1.0f : far ? 0.5f : 0.0f;
    p.depth[i] = near ? 2.0f : far ? 3.0f : std::numeric_limits<float>::infinity();
    p.motion[i] = {near ? 0.0f : far ? 4.0f : 12.0f, 0};
  });
  StereoSetup setup;
  setup.longest_fill = 20;
  setup.filter = StereoFilter::kBox;
  const Result result = other_eye(p, setup);
  for (int x = 20; x < 44; ++x) {
    EXPECT_EQ(result.color[p.at(x, 3)], x < 30 ? 1.0f : 0.5f) << x;
    EXPECT_EQ(result.invented[p.at(x, 3)], x >= 30 && x < 34 ? 1.0f : 0.0f) << x;
  }
}

TEST(Stereo, TheSidesAreContinuedWithTheParallaxOfWhatIsThere) {
  // A bar at the right side, before a plane that moves three pixels further: beyond the side, bar and plane
  // are mirrored, and the plane appears between them as it does where it was seen.
  Picture p(60, 4);
  p.each([&](int x, int, size_t i) {
    const bool near = x >= 50 && x < 57;
    p.color[i] = near ? 1.0f : 0.25f;
    p.depth[i] = near ? 2.0f : 8.0f;
    p.motion[i] = {near ? -9.0f : -12.0f, 0};
  });
  StereoSetup setup;
  setup.filter = StereoFilter::kBox;
  setup.longest_fill = kFillEverything;
  const Result result = other_eye(p, setup);
  // Of the plane's 57 .. 62 at 45 .. 50, the bar at 41 .. 47 hides the first three; the mirrored bar is
  // columns 63 .. 69.
  for (int x = 0; x < 60; ++x) {
    const bool near = (x >= 41 && x < 48) || (x >= 54 && x < 61);
    EXPECT_EQ(result.color[p.at(x, 2)], near ? 1.0f : 0.25f) << x;
    EXPECT_EQ(result.missing[p.at(x, 2)], 0) << x;
    const bool is_uncovered = x >= 38 && x < 41;  // left of the bar
    EXPECT_EQ(result.invented[p.at(x, 2)], is_uncovered || x >= 48 ? 1.0f : 0.0f) << x;
  }
}

TEST(Stereo, TheSkyIsSeenBesideAThinThing) {
  // Two strands part, as in NothingShinesThroughAGap, but the one behind is partly covered.
  Picture p(80, 6);
  std::vector<uint8_t> is_thin(80 * 6);
  p.each([&](int x, int, size_t i) {
    const bool near = x == 30, far = x == 31;
    is_thin[i] = far;
    p.depth[i] = near ? 2.0f : far ? 3.0f : std::numeric_limits<float>::infinity();
    p.motion[i] = {near ? 0.0f : far ? 4.0f : 3.0f, 0};
  });
  const Workers workers(1);
  const FlowField solid(80, 6, p.motion, p.depth, LinkLimits(), workers);
  const FlowField thin(80, 6, p.motion, p.depth, LinkLimits(), workers, &is_thin);
  EXPECT_TRUE(solid.has_seam(31, 2));
  EXPECT_FALSE(thin.has_seam(31, 2));
}

TEST(Stereo, TheLargestColorsStayFinite) {
  constexpr float kLargest = std::numeric_limits<float>::max();
  for (const StereoFilter filter : {StereoFilter::kLanczos, StereoFilter::kBox}) {
    Picture p = two_planes(-6.4f, 1.3f);
    p.each([&](int x, int y, size_t i) { p.color[i] = (x + y) % 5 == 0 ? -kLargest : kLargest; });
    StereoSetup setup;
    setup.filter = filter;
    setup.longest_fill = 20;
    for (const float v : other_eye(p, setup).color) ASSERT_TRUE(std::isfinite(v));
    p.each([&](int, int, size_t i) { p.color[i] = 1e38f; });
    for (const float v : other_eye(p, setup).color) ASSERT_FLOAT_EQ(v, 1e38f);
  }
}

TEST(Stereo, ThereAndBackIsTheSamePicture) {
  // Smooth textures on a slanted plane and on a bar before it.
  Picture left(240, 40);
  const StereoCamera right_eye{300, 0.3f, 10}, back{300, -0.3f, 10};
  left.each([&](int x, int y, size_t i) {
    const bool near = x >= 100 && x < 150;
    left.depth[i] = near ? 6.0f : 14.0f + 0.01f * static_cast<float>(x);
    const float fx = static_cast<float>(x), fy = static_cast<float>(y);
    left.color[i] = near ? 0.6f + 0.3f * std::sin(fx * 0.21f) * std::cos(fy * 0.3f)
                         : 0.4f + 0.3f * std::sin(fx * 0.13f + fy * 0.2f);
  });
  left.motion = parallax_field(left.depth, right_eye);
  StereoSetup setup;
  setup.longest_fill = 6;
  const Result right = other_eye(left, setup);

  Picture there(240, 40);
  there.color = right.color;
  there.depth = right.depth;
  there.motion = parallax_field(there.depth, back);
  // What was invented must come back marked: as data.
  there.data = right.invented;
  const Result again = other_eye(there, setup);
  double error = 0;
  int count = 0;
  left.each([&](int x, int, size_t i) {
    const bool at_edge = x < 20 || x >= 220 || std::abs(x - 100) < 4 || std::abs(x - 150) < 4;
    if (at_edge || again.invented[i] > 0 || again.data[i] > 0) return;
    error += std::pow(static_cast<double>(again.color[i] - left.color[i]), 2);
    ++count;
  });
  EXPECT_GT(count, 240 * 40 * 2 / 3);
  const double psnr = -10 * std::log10(error / count);
  EXPECT_GT(psnr, 40);
  RecordProperty("psnr", std::to_string(psnr));
}

TEST(Stereo, SamePixelsForAnyStripAndNumberOfThreads) {
  Picture p(97, 53);
  p.each([&](int x, int y, size_t i) {
    const bool near = (x / 8 + y / 9) % 3 == 0;
    p.depth[i] = near ? 2.0f : 6.0f;
    p.motion[i] = {near ? -5.7f : 0.13f * static_cast<float>(y), 0};
  });
  for (const StereoFilter filter : {StereoFilter::kLanczos, StereoFilter::kBox}) {
    StereoSetup setup;
    setup.filter = filter;
    setup.longest_fill = 3;
    setup.strip_rows = 53;
    setup.threads = 1;
    const Result whole = other_eye(p, setup);
    for (int rows : {1, 2, 7, 16}) {
      setup.strip_rows = rows;
      setup.threads = rows;
      const Result result = other_eye(p, setup);
      ASSERT_EQ(bits(result.color), bits(whole.color)) << rows;
      ASSERT_EQ(bits(result.data), bits(whole.data)) << rows;
      ASSERT_EQ(bits(result.invented), bits(whole.invented)) << rows;
      ASSERT_EQ(bits(result.missing), bits(whole.missing)) << rows;
    }
  }
}

}  // namespace
}  // namespace pelage
