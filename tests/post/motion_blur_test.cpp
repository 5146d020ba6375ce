// SPDX-License-Identifier: Apache-2.0
#include "post/motion_blur.h"

#include <algorithm>
#include <limits>

#include <gtest/gtest.h>

#include "tests/post/picture.h"
#include "tests/support/effort.h"

namespace pelage {
namespace {

constexpr float kInfinity = std::numeric_limits<float>::infinity();
constexpr float kNan = std::numeric_limits<float>::quiet_NaN();

std::vector<float> times(float length, int steps) { return shutter_times({length, 0, steps}, 1); }

/// Rigid and torn surfaces, gaps and overlaps.
Picture lively_picture(int width, int height) {
  Picture p(width, height);
  p.each([&](int x, int y, size_t i) {
    const bool near = (x / 9 + y / 7) % 3 == 0;
    p.depth[i] = near ? 2.0f : 5.0f + 0.01f * static_cast<float>(x);
    p.motion[i] = near ? Flow{9, -4}
                       : Flow{0.3f * static_cast<float>(y - height / 2), 0.2f * static_cast<float>(x - 20)};
    if (x % 11 == 3 && y % 5 == 2) p.depth[i] = kInfinity;
  });
  return p;
}

TEST(MotionBlur, NoMotionIsTheIdentityToTheBit) {
  Picture p(150, 40);
  p.color[7] = -0.0f;
  p.color[8] = kNan;
  p.color[9] = kInfinity;
  p.depth[10] = kNan;
  p.depth[11] = kInfinity;
  p.depth[12] = 0;
  p.depth[13] = -3;
  for (int scale : {1, 2, 3, 4, 6, 8}) {
    for (int steps : {1, 7, 16}) {
      BlurSetup setup;
      setup.scale = scale;
      setup.times = times(0.5f, steps);
      const Result result = blurred(p, setup);
      EXPECT_EQ(bits(result.color), bits(p.color)) << scale << " " << steps;
      EXPECT_EQ(bits(result.data), bits(p.data));
      EXPECT_EQ(bits(result.depth), bits(p.depth));
    }
  }
}

TEST(MotionBlur, ListsOfWildPixelsChangeNothing) {
  // Descending times are drawn without lists; whole samples, so that the order of sums does not matter.
  Picture p = lively_picture(150, 60);
  p.each([&](int x, int y, size_t i) {
    if (x % 3 != 0) p.motion[i] = {400 * signed_float(hash64(i, 1)), 300 * signed_float(hash64(i, 2))};
    p.color[i] = static_cast<float>((x + y) % 7);
  });
  BlurSetup setup;
  setup.times = times(1, 32);
  setup.longest_seam = 4;
  const Result listed = blurred(p, setup);
  std::reverse(setup.times.begin(), setup.times.end());
  const Result direct = blurred(p, setup);
  EXPECT_EQ(bits(listed.color), bits(direct.color));
  EXPECT_EQ(bits(listed.data), bits(direct.data));
  EXPECT_EQ(bits(listed.depth), bits(direct.depth));
}

TEST(MotionBlur, TheLargestColorsStayFinite) {
  constexpr float kLargest = std::numeric_limits<float>::max();
  Picture p = lively_picture(80, 40);
  BlurSetup setup;
  setup.scale = 8;
  setup.times = times(0.5f, 200);
  setup.longest_seam = 4;
  p.each([&](int x, int y, size_t i) { p.color[i] = (x + y) % 5 == 0 ? -kLargest : kLargest; });
  for (const float v : blurred(p, setup).color) ASSERT_TRUE(std::isfinite(v));
  p.each([&](int, int, size_t i) { p.motion[i] = {5.3f, 0}; });
  p.each([&](int, int, size_t i) { p.color[i] = 1e38f; });
  const Result result = blurred(p, setup);
  for (int x = 10; x < 70; ++x) EXPECT_NEAR(result.color[p.at(x, 20)], 1e38, 1e33);
  // Infinities of both signs cancel.
  p.each([&](int x, int, size_t i) { p.color[i] = x % 2 == 0 ? kInfinity : -kInfinity; });
  EXPECT_EQ(blurred(p, setup).color[p.at(40, 20)], 0);
}

TEST(MotionBlur, WholePixelsAreShiftedToTheBit) {
  Picture p(90, 30);
  p.each([&](int, int, size_t i) { p.motion[i] = {7, -3}; });
  for (int scale : {1, 3, 4, 6}) {
    BlurSetup setup;
    setup.scale = scale;
    setup.times = {1};
    const Result result = blurred(p, setup);
    for (int y = 0; y < p.height; ++y) {
      for (int x = 0; x < p.width; ++x) {
        const bool inside = x >= 7 && y + 3 < p.height;
        ASSERT_EQ(result.color[p.at(x, y)], inside ? p.color[p.at(x - 7, y + 3)] : 0) << x << " " << y;
        ASSERT_EQ(result.data[p.at(x, y)], inside ? p.data[p.at(x - 7, y + 3)] : 0);
        ASSERT_EQ(result.depth[p.at(x, y)], inside ? 1 : kInfinity);
      }
    }
  }
}

TEST(MotionBlur, AnEdgeBecomesTheAnalyticRamp) {
  // White left of x = 40, black right of it, all of it moving by m: over the shutter the edge is spread
  // evenly over |m| S pixels.
  for (int scale : {2, 4, 6}) {
    for (float m : {5.3f, 12.7f, -20.2f, 0.37f}) {
      Picture p(80, 6);
      p.each([&](int x, int, size_t i) {
        p.color[i] = x < 40 ? 1.0f : 0.0f;
        p.motion[i] = {m, 0};
      });
      constexpr float kShutter = 0.5f;
      constexpr int kSteps = 96;  // fine enough not to be seen beside the samples
      BlurSetup setup;
      setup.scale = scale;
      setup.times = times(kShutter, kSteps);
      setup.largest_time = kShutter / 2;
      const Result result = blurred(p, setup);
      const double half = std::abs(m) * kShutter / 2;
      // Integral over a pixel of the part of the shutter during which a point is white.
      const auto white_to = [&](double x) {
        const double t = (x - (40 - half)) / (2 * half);
        if (t <= 0) return x;
        if (t >= 1) return 40.0;
        return x - (x - (40 - half)) * t / 2;
      };
      double worst = 0;
      for (int x = 20; x < 60; ++x) {
        const double truth = white_to(x + 1) - white_to(x);
        worst = std::max(worst, std::abs(truth - static_cast<double>(result.color[p.at(x, 3)])));
      }
      EXPECT_LE(worst, 1.0 / (2 * scale)) << scale << " " << m;
    }
  }
}

TEST(MotionBlur, NearHidesFarWhicheverComesFirst) {
  for (bool left_is_near : {true, false}) {
    Picture p(60, 8);
    p.each([&](int x, int, size_t i) {
      const bool is_left = x < 30;
      p.color[i] = is_left ? 1.0f : 0.25f;
      p.depth[i] = is_left == left_is_near ? 2.0f : 9.0f;
      p.motion[i] = {is_left ? 6.0f : -6.0f, 0};
    });
    BlurSetup setup;
    setup.times = {1};
    const Result result = blurred(p, setup);
    for (int x = 26; x < 34; ++x) {  // where both have come to lie
      EXPECT_EQ(result.color[p.at(x, 4)], left_is_near ? 1.0f : 0.25f) << x;
      EXPECT_EQ(result.depth[p.at(x, 4)], 2.0f);
    }
  }
}

TEST(MotionBlur, EqualDepthsAreDecidedByPlace) {
  Picture p(40, 4);
  p.each([&](int x, int, size_t i) {
    p.color[i] = x < 20 ? 1.0f : 0.5f;
    p.motion[i] = {x < 20 ? 8.0f : -8.0f, 0};
  });
  BlurSetup setup;
  setup.times = {1};
  const Result result = blurred(p, setup);
  for (int x = 14; x < 26; ++x) EXPECT_EQ(result.color[p.at(x, 2)], 1.0f) << x;
}

TEST(MotionBlur, ASurfaceThatTurnsAndSwellsHasNoCracks) {
  Picture p(120, 90);
  p.each([&](int x, int y, size_t i) {
    const auto dx = static_cast<float>(x - 60), dy = static_cast<float>(y - 45);
    p.color[i] = 1;
    p.depth[i] = 10 + 0.001f * dx;
    p.motion[i] = {0.35f * dx - 0.4f * dy, 0.4f * dx + 0.35f * dy};
  });
  for (int scale : {1, 3, 4, 8}) {
    BlurSetup setup;
    setup.scale = scale;
    setup.times = {1};
    const Result result = blurred(p, setup);
    for (int y = 10; y < 80; ++y) {
      for (int x = 10; x < 110; ++x)
        ASSERT_EQ(result.color[p.at(x, y)], 1.0f) << x << " " << y << " " << scale;
    }
  }
}

TEST(MotionBlur, WhatIsUncoveredStaysEmpty) {
  Picture p(60, 10);
  p.each([&](int x, int, size_t i) {
    p.color[i] = 1;
    const bool moves = x >= 20 && x < 30;
    p.depth[i] = moves ? 1.0f : 4.0f;
    p.motion[i] = {moves ? 15.0f : 0.0f, 0};
  });
  BlurSetup setup;
  setup.times = {1};
  const Result result = blurred(p, setup);
  for (int x = 0; x < 60; ++x) {
    EXPECT_EQ(result.color[p.at(x, 5)], x >= 20 && x < 30 ? 0.0f : 1.0f) << x;
    EXPECT_EQ(result.depth[p.at(x, 5)], x >= 20 && x < 30 ? kInfinity : x >= 35 && x < 45 ? 1.0f : 4.0f) << x;
  }
}

/// A near bar that moves by `motion` before a plane that stays, with nothing from x = 50 on.
Picture bar_before_a_plane(Flow motion) {
  Picture p(60, 40);
  p.each([&](int x, int y, size_t i) {
    const bool bar = x >= 20 && x < 30 && y >= 10 && y < 30;
    p.color[i] = bar ? 1.0f : x < 50 ? 0.5f : 0.0f;
    p.depth[i] = bar ? 1.0f : x < 50 ? 4.0f : kInfinity;
    if (bar) p.motion[i] = motion;
  });
  return p;
}

TEST(MotionBlur, NarrowGapsAreClosedFromBehind) {
  for (const Flow motion : {Flow{3, 0}, Flow{-3, 0}, Flow{0, 3}, Flow{0, -3}, Flow{2.6f, -1.7f}}) {
    const Picture p = bar_before_a_plane(motion);
    BlurSetup setup;
    setup.times = {1};
    const Result open = blurred(p, setup);
    setup.longest_seam = 3;
    const Result closed = blurred(p, setup);
    int filled = 0;
    Picture(p).each([&](int x, int, size_t i) {
      ASSERT_EQ(closed.color[i] > 0, x < 50) << i;
      ASSERT_LE(closed.depth[i], open.depth[i]);
      if (open.color[i] == closed.color[i]) return;
      ++filled;
      // Never lighter than what is behind: nothing of the bar is smeared.
      EXPECT_LE(closed.color[i] - open.color[i], 0.5f);
    });
    EXPECT_GE(filled, 30);
    setup.longest_seam = 1.5f;  // too wide: left alone, whole
    EXPECT_EQ(bits(blurred(p, setup).color), bits(open.color));
  }
}

TEST(MotionBlur, SeamsHideNothing) {
  // Where surfaces are, seams change neither colours nor data; they only take what was empty.
  Picture p = lively_picture(120, 60);
  BlurSetup setup;
  setup.times = {1};
  setup.scale = 1;  // a sample a pixel
  const Result without = blurred(p, setup);
  setup.longest_seam = 8;
  const Result with = blurred(p, setup);
  size_t filled = 0;
  for (size_t i = 0; i < p.color.size(); ++i) {
    if (without.depth[i] == kInfinity) {
      filled += with.depth[i] != kInfinity;
    } else {
      ASSERT_EQ(with.color[i], without.color[i]);
      ASSERT_EQ(with.data[i], without.data[i]);
    }
  }
  EXPECT_GT(filled, 100u);
}

TEST(MotionBlur, SamePixelsForAnyTilingAndNumberOfThreads) {
  const Picture p = lively_picture(173, 61);
  BlurSetup setup;
  setup.times = times(0.5f, 9);
  setup.largest_time = 0.25f;
  setup.longest_seam = 5;
  setup.threads = 1;
  setup.tiling = {173, 61};
  const Result whole = blurred(p, setup);
  for (const PostTiling tiling :
       {PostTiling{173, 1}, PostTiling{1, 61}, PostTiling{31, 5}, PostTiling{128, 16}}) {
    for (int threads : {1, 3, 5}) {
      if (kSanitized && threads != 3) continue;
      setup.threads = threads;
      setup.tiling = tiling;
      const Result result = blurred(p, setup);
      ASSERT_EQ(bits(result.color), bits(whole.color))
          << tiling.columns << " " << tiling.rows << " " << threads;
      ASSERT_EQ(bits(result.data), bits(whole.data));
      ASSERT_EQ(bits(result.depth), bits(whole.depth));
    }
  }
}

TEST(MotionBlur, BandsJoinWithoutASeam) {
  Picture p = lively_picture(80, 64);
  BlurSetup setup;
  setup.times = times(1, 8);
  setup.longest_seam = 6;
  const WarpTarget target{4, 0, 0, setup.longest_seam};
  const Result whole = blurred(p, setup);
  const Workers workers(2);
  const FlowField field(p.width, p.height, p.motion, p.depth, LinkLimits(), workers);
  Result parts;
  PostLayers layers = layers_of(p, parts);
  NoProgress progress;
  for (int row = 0; row < p.height; row += 10) {
    const int last = std::min(row + 10, p.height);
    // Only the rows that are said to be needed hold pixels.
    const RowRange rows = rows_reaching(field, target, p.width, row, last, setup.times);
    Picture cut = p;
    cut.each([&](int, int y, size_t i) {
      if (y < rows.first || y >= rows.last) cut.color[i] = 1e6f;
    });
    layers.channels[0].source.words = cut.color.data();
    blur_rows({&field, target, setup.times, p.width, row, last}, layers, {}, workers, progress);
  }
  EXPECT_EQ(bits(parts.color), bits(whole.color));
}

TEST(MotionBlur, AbsurdVectorsAndDepthsAreHarmless) {
  Picture p(64, 24);
  const float values[] = {kNan, kInfinity, -kInfinity, 1e30f, -1e30f, 3e38f, 1e5f, 0, 1e-40f};
  p.each([&](int, int, size_t i) {
    const uint64_t h = hash64(i, random_use("absurd"));
    if (h % 3 == 0) p.motion[i] = {values[h / 3 % 9], values[h / 27 % 9]};
    if (h % 5 == 0) p.depth[i] = values[h / 81 % 9];
  });
  BlurSetup setup;
  setup.times = times(0.5f, 8);
  setup.largest_time = 0.25f;
  for (const float v : blurred(p, setup).color) ASSERT_TRUE(std::isfinite(v));
  for (float& z : p.depth) z = 1;
  p.each([&](int, int, size_t i) { p.motion[i] = {1e9f, 0}; });
  setup.times = {1};
  for (const float v : blurred(p, setup).color) ASSERT_EQ(v, 0);  // all of it has left
}

TEST(MotionBlur, NotANumberStaysWhereItIsSeenAlone) {
  Picture p(40, 6);
  p.each([&](int, int, size_t i) {
    p.color[i] = 1;
    p.motion[i] = {4, 0};
  });
  p.color[p.at(20, 3)] = kNan;
  BlurSetup setup;
  setup.times = times(1, 8);
  const Result result = blurred(p, setup);
  for (int x = 10; x < 30; ++x) {
    const float v = result.color[p.at(x, 3)];
    EXPECT_TRUE(v > 0.7f && v <= 1.0f) << x << " " << v;
  }
}

TEST(MotionBlur, DepthOfDataIsTheNearestSeen) {
  Picture p(40, 6);
  p.each([&](int x, int, size_t i) {
    p.depth[i] = x >= 15 && x < 20 ? 1.0f : 8.0f;
    p.motion[i] = {x >= 15 && x < 20 ? 8.0f : 0.0f, 0};
  });
  BlurSetup setup;
  setup.times = times(1, 16);
  const Result result = blurred(p, setup);
  for (int x = 12; x < 23; ++x) EXPECT_EQ(result.depth[p.at(x, 3)], 1.0f) << x;
  EXPECT_EQ(result.depth[p.at(8, 3)], 8.0f);
  EXPECT_EQ(result.data[p.at(8, 3)], p.data[p.at(8, 3)]);
}

TEST(MotionBlur, TheShutterIsCentredAndFollowsTheMotion) {
  EXPECT_EQ(shutter_times({0.5f, 0, 1}, 100), std::vector<float>{0});
  EXPECT_EQ(shutter_times({0.5f, 0, 0}, 0).size(), 1u);
  EXPECT_EQ(shutter_times({0.5f, 0, 0}, 3).size(), 8u);
  EXPECT_EQ(shutter_times({0.5f, 0, 0}, 60).size(), 30u);
  EXPECT_EQ(shutter_times({0.5f, 0, 0}, 1e9f).size(), 64u);
  float sum = 0;
  for (float t : shutter_times({1, 0, 7}, 1)) sum += t;
  EXPECT_NEAR(sum, 0, 1e-6);
}

}  // namespace
}  // namespace pelage
