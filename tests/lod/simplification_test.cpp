// SPDX-License-Identifier: Apache-2.0
#include "lod/simplification.h"

#include <algorithm>
#include <cmath>
#include <vector>

#include <gtest/gtest.h>

#include "base/hash.h"
#include "lod/lod_view.h"

namespace pelage {
namespace {

LodView view_from(const V3f& position, float focal_pixels = 1000) {
  LodView view;
  view.open.position = view.close.position = position;
  view.open.focal_pixels = view.close.focal_pixels = focal_pixels;
  return view;
}

constexpr CoatStats kHair{0.01f, 1.0f, 1e-5f};

Simplification sized(const CoatStats& stats = kHair, float budget = 1) {
  return {SimplificationParams{}, view_from(V3f(0)), stats, budget};
}

float share_at(const Simplification& s, float distance) {
  return s.share({V3f(0, 0, -distance), V3f(0, 0, -distance)});
}

TEST(Simplification, KeepsEverythingUpClose) {
  const Simplification s = sized();
  EXPECT_EQ(share_at(s, 9), 1);  // 1.1 pixels wide
  EXPECT_EQ(s.width_factor(1, 0.999f), 1);
  EXPECT_EQ(s.contrast(1), 1);
}

TEST(Simplification, SharesFallSmoothlyWithTheDistance) {
  const Simplification s = sized();
  float before = 1;
  for (float distance = 5; distance < 5000; distance *= 1.001f) {
    const float share = share_at(s, distance);
    EXPECT_LE(share, before * (1 + 1e-6f));  // equal shares are off by rounding
    EXPECT_GT(share, before * 0.997f);
    EXPECT_LE(share, s.max_share(distance));
    before = share;
  }
}

TEST(Simplification, MeasuresSayHowAShareComesAbout) {
  SimplificationParams params;
  params.quality = 2;
  params.min_share = 1e-4f;
  for (const float budget : {1.0f, 1.5f, 0.5f}) {
    LodView view = view_from(V3f(0));
    view.lens_diameter = 0.05f;
    view.focus_distance = 100;
    const Simplification s(params, view, kHair, budget);
    const RootPlace root{V3f(0, 0, -60), V3f(0.05f, 0, -60), V3f(0.8f, 0, -0.6f), V3f(1, 0, 0)};
    const LodMeasures m = s.measures(root);
    EXPECT_NEAR(m.width, 2 * 0.01f * 1000 / 60, 1e-4f);
    EXPECT_NEAR(m.length, 2 * 1000.0f / 60, 1e-2f);
    EXPECT_NEAR(m.motion, 0.05f * 2 * 1000 / 60, 1e-2f);
    EXPECT_NEAR(m.across, 0, 1e-2f) << "it moves along itself";
    EXPECT_GT(m.confusion, 0);
    EXPECT_NEAR(m.facing, -0.6f, 1e-4f);
    EXPECT_LT(m.size_share, 1);
    EXPECT_LT(m.blur_share, 1);
    EXPECT_LT(m.facing_share, 1);
    EXPECT_EQ(m.budget, budget);
    EXPECT_EQ(m.share, s.share(root));
    // Widened strands may not be wider than a pixel, so more are kept than the factors ask for.
    EXPECT_GT(m.share, m.size_share * m.blur_share * m.facing_share * m.budget);
    const LodMeasures near = s.measures({V3f(0, 0, -5), V3f(0, 0, -5), V3f(0, 0, -1)});
    EXPECT_EQ(near.size_share, 1);
    EXPECT_NEAR(near.share, near.facing_share, 1e-6f) << "only the direction of the skin thins it out";
  }
}

TEST(Simplification, NoStrandGrowsBeyondThePixelOrAQuarterOfItself) {
  for (const float length : {0.1f, 1.0f, 5.0f}) {
    const CoatStats stats{0.01f, length, 1e-6f};
    const Simplification s = sized(stats);
    for (float distance = 5; distance < 1e4f; distance *= 1.1f) {
      const float share = share_at(s, distance), pixels = 1000 / distance;
      if (share >= 1) continue;
      const float widened = 0.01f * pixels * s.width_factor(share, 0);
      EXPECT_LE(widened, 1.0001f) << distance;
      EXPECT_LE(widened, 0.2501f * length * pixels) << distance;
      EXPECT_LE(s.width_factor(share, 0), s.max_width_factor(distance));
    }
  }
}

TEST(Simplification, BlurThinsFurtherAndLetsStrandsBeAsWideAsATenthOfIt) {
  SimplificationParams params;
  const float distance = 30;
  const V3f here(0, 0, -distance);
  LodView view = view_from(V3f(0));
  const Simplification still(params, view, kHair, 1);
  float before = still.share({here, here});
  for (float pixels = 0.1f; pixels < 100; pixels *= 1.3f) {
    const V3f there = here + V3f(pixels * distance / 1000, 0, 0);
    const float share = still.share({here, there});
    EXPECT_LE(share, before * (1 + 1e-6f));  // equal shares are off by rounding
    const float width = 0.01f * 1000 / distance * still.width_factor(share, 0);
    EXPECT_LE(width, std::hypot(1.0f, 0.1f * pixels) * 1.0001f);
    EXPECT_LE(still.width_factor(share, 0), still.max_width_factor(distance));
    before = share;
  }
  EXPECT_LT(before, 0.3f * still.share({here, here}));
  view.lens_diameter = 2;
  view.focus_distance = 10;
  EXPECT_LT(Simplification(params, view, kHair, 1).share({here, here}), 0.5f * still.share({here, here}));
  // Each has its switch.
  params.depth_of_field = false;
  EXPECT_EQ(Simplification(params, view, kHair, 1).share({here, here}), still.share({here, here}));
  params.motion_blur = false;
  EXPECT_EQ(Simplification(params, view, kHair, 1).share({here, here + V3f(3, 0, 0)}),
            still.share({here, here}));
  params.size = false;
  params.min_share = 1;
  EXPECT_EQ(Simplification(params, view, kHair, 1).share({here, here}), 1);
}

TEST(Simplification, MotionHidesTheWidthOfStrandsAcrossItOnly) {
  const float distance = 30, pixels = 100;
  const V3f here(0, 0, -distance), there = here + V3f(pixels * distance / 1000, 0, 0);
  const Simplification s = sized({0.01f, 5.0f, 1e-6f});
  const float still = s.share({here, here});
  float before = 2;
  for (int degrees = 0; degrees <= 90; degrees += 5) {
    const float angle = static_cast<float>(degrees) * 0.0174532925f;
    RootPlace root{here, there};
    root.direction = V3f(std::cos(angle), std::sin(angle), 0);
    const float share = s.share(root);
    EXPECT_LT(share, before) << degrees;
    EXPECT_LE(share, still);
    EXPECT_LE(0.01f * 1000 / distance * s.width_factor(share, 0),
              std::hypot(1.0f, 0.1f * pixels * std::sin(angle)) * 1.0001f);
    root.direction = -root.direction;
    EXPECT_EQ(s.share(root), share);
    EXPECT_LE(share, s.max_share(distance));
    EXPECT_LE(s.width_factor(share, 0), s.max_width_factor(distance));
    before = share;
  }
  EXPECT_LT(before, 0.3f * still);
  // Without a direction, and along the line of sight, all is across or nearly.
  EXPECT_EQ(s.share({here, there, V3f(0), V3f(0, 0, 1)}), before);
  EXPECT_LT(s.share({here, there}), 1.6f * before);
}

TEST(Simplification, FewerStayWhereTheSkinIsTurnedAway) {
  SimplificationParams params;
  for (const auto& [distance, length] : {std::pair{5.0f, 1.0f}, {100.0f, 1.0f}, {100.0f, 0.02f}}) {
    const V3f here(0, 0, -distance);
    const Simplification s(params, view_from(V3f(0)), {0.01f, length, 1e-5f}, 1);
    const float whole = s.share({here, here});
    float before = whole;
    for (int degrees = 0; degrees <= 180; ++degrees) {
      const float angle = static_cast<float>(degrees) * 0.0174532925f;
      const float share = s.share({here, here, V3f(std::sin(angle), 0, std::cos(angle))});
      EXPECT_LE(share, before);
      EXPECT_GT(share, before - 0.056f * whole);  // in steps of a degree
      if (degrees <= 95) {
        EXPECT_EQ(share, whole);  // what is seen, and what stands on the edge
      }
      EXPECT_LE(s.width_factor(share, 0), s.max_width_factor(distance));
      before = share;
    }
    EXPECT_FLOAT_EQ(before, 0.2f * whole);
  }
  params.back_facing = false;
  const V3f here(0, 0, -100);
  const Simplification all(params, view_from(V3f(0)), kHair, 1);
  EXPECT_EQ(all.share({here, here, V3f(0, 0, -1)}), all.share({here, here}));
}

TEST(Simplification, TheMeanOfTheFadeIsTheShare) {
  for (const float share : {0.003f, 0.02f, 0.05f, 0.2f, 0.39f, 0.5f, 0.9f, 0.95f, 0.999f}) {
    const int n = 200000;
    double sum = 0;
    int kept = 0;
    for (int i = 0; i < n; ++i) {
      const float f = Simplification::fade(share, (static_cast<float>(i) + 0.5f) / n);
      sum += f;
      kept += f > 0;
    }
    EXPECT_NEAR(sum / n, share, 2e-5) << share;
    EXPECT_LE(kept, n * share * 1.2501 + 1) << share;
  }
}

TEST(Simplification, TheVisibleAreaStays) {
  // 1 - (1 - r)^N of the full coat and 1 - (1 - r s)^(lambda N) of what is left.
  for (const float r : {1e-6f, 1e-4f, 0.01f}) {
    const Simplification s = sized({0.01f, 1, r});
    for (const float share : {0.03f, 0.1f, 0.5f, 0.9f}) {
      const double gain = s.width_factor(share, 0);
      for (const double depth : {0.1, 1.0, 3.0}) {
        const double n = depth / r;
        EXPECT_NEAR(std::exp(share * n * std::log1p(-r * gain)), std::exp(n * std::log1p(-r)), 1e-4);
      }
    }
  }
  EXPECT_NEAR(sized({0.01f, 1, 0.01f}).width_factor(0.1f, 0), 9.56, 0.01);
}

// Intervals of length mu / n at n places of a line of length 1 that keep a distance of room / n: brute force.
TEST(Simplification, WhatIsCoveredStaysWhereStrandsStandEvenly) {
  const CoatStats stats{0.002f, 0.5f, 1e-6f, 1200.0f, true};
  const Simplification s = sized(stats);
  const auto bare = [&](float share) {
    const double width = stats.width * s.gain(share), density = stats.density * share;
    const double on_line = density * width, room = 0.6 * std::sqrt(density) * width / on_line;
    // Gaps behind the room that each takes up are exponential.
    const double mean_gap = 1 / on_line - room;
    double at = 0, clear = 0;
    for (uint64_t i = 0; i < 400000; ++i) {
      const double gap = room - mean_gap * std::log(1 - unit_float(hash64(i, 7)));
      clear += std::max(0.0, gap - stats.length);
      at += gap;
    }
    return clear / at;
  };
  const double full = bare(1);
  EXPECT_GT(full, 0.2);
  for (const float share : {0.9f, 0.5f, 0.1f, 0.03f}) EXPECT_NEAR(bare(share), full, 0.004) << share;
  EXPECT_LT(s.gain(0.03f), 0.9f / 0.03f);
  CoatStats anywhere = stats;
  anywhere.even = false;
  EXPECT_NEAR(sized(anywhere).gain(0.03f), 1 / 0.03f, 0.01f);
}

TEST(Simplification, LightStartsFartherAwayTheMoreAStrandStandsFor) {
  CoatStats stats{0.002f, 0.5f, 1e-6f, 1200.0f, true};
  const Simplification s = sized(stats);
  EXPECT_EQ(s.spread(1), 0);
  EXPECT_EQ(s.own_shadow(1), 0);
  float spread = 0, shadow = 0;
  for (float share = 0.999f; share > 0.01f; share *= 0.98f) {
    EXPECT_GE(s.spread(share), spread);
    EXPECT_GE(s.own_shadow(share), shadow);
    EXPECT_LT(s.spread(share), 4.001f * stats.width * s.gain(share));
    EXPECT_NEAR(s.spread(share), spread, 0.02f / std::sqrt(share));  // continuous
    EXPECT_NEAR(s.own_shadow(share), shadow, 0.05f);
    spread = s.spread(share);
    shadow = s.own_shadow(share);
  }
  EXPECT_GT(shadow, 0.5f);
  EXPECT_LT(shadow, 1.0f);
  stats.density = 0;  // not known
  EXPECT_EQ(sized(stats).spread(0.1f), 0);
  stats.density = 1200;
  stats.even = false;  // as in a strands file: no room
  EXPECT_EQ(sized(stats).own_shadow(0.1f), 0);
}

TEST(Simplification, IsNestedAndContinuous) {
  const Simplification s = sized();
  for (float x = 0.0005f; x < 1; x += 0.00731f) {
    float before = s.width_factor(1, x);
    EXPECT_EQ(before, 1);
    for (float share = 1; share > 0.002f; share *= 0.9999f) {
      const float width = s.width_factor(share, x);
      // Who has gone does not come back.
      if (before == 0) {
        ASSERT_EQ(width, 0) << x << " " << share;
      }
      // From full width to none in no fewer than some hundred steps of 1e-4 of the share; those that come
      // last do so while the fade is still short.
      const float t = std::max(Simplification::fade_half_width(share), 1e-4f);
      ASSERT_LT(std::abs(width - before), (1e-4f * share / t + 2e-3f) / share) << x << " " << share;
      before = width;
    }
  }
}

TEST(Simplification, BudgetsAndQualityKeepMore) {
  const float plain = share_at(sized(), 100);
  EXPECT_NEAR(share_at(sized(kHair, 3), 100), 3 * plain, 1e-5);
  SimplificationParams params;
  params.quality = 2;
  EXPECT_NEAR(share_at({params, view_from(V3f(0)), kHair, 1}, 100), 2 * plain, 1e-5);
}

// A small budget thins out sooner, but strands become no wider than others' do, and what is always kept is.
TEST(Simplification, SmallBudgetsKeepWhatIsLeast) {
  SimplificationParams params;
  params.min_share = 0.02f;
  const Simplification s(params, view_from(V3f(0)), kHair, 0.1f), all = sized();
  for (const float distance : {12.0f, 20.0f, 100.0f, 1000.0f, 1e5f}) {
    const float share = share_at(s, distance), width = 0.01f * 1000 / distance;
    EXPECT_LE(share, share_at(all, distance) + 1e-6f);
    EXPECT_GE(share, std::min(1.0f, width / std::min(1.0f, 25 * width)) * 0.999f) << distance;
    EXPECT_GE(share, 0.02f);
    EXPECT_LE(s.width_factor(share, 0), s.max_width_factor(distance));
  }
}

// Frame by frame, each 1 % farther away: the criterion of docs/LOD.md.
TEST(Simplification, NothingPopsInADolly) {
  const Simplification s = sized();
  const int n = 4000;
  float before = 1;
  for (float distance = 5; distance < 3000; distance *= 1.01f) {
    const float share = share_at(s, distance);
    float largest = 0, sum = 0;
    for (int i = 0; i < n; ++i) {
      const float priority = (static_cast<float>(i) + 0.5f) / n;
      const float change =
          std::abs(Simplification::fade(share, priority) - Simplification::fade(before, priority));
      largest = std::max(largest, change);
      sum += change;
    }
    EXPECT_LE(sum / n, 0.016f) << share;
    if (before <= 0.9f) {
      EXPECT_LE(largest, 0.07f) << share;
    }
    before = share;
  }
}

TEST(Simplification, WithoutWidthStrandsAreOnlyThinned) {
  SimplificationParams params;
  params.width_gain = false;
  const Simplification s(params, view_from(V3f(0)), kHair, 1);
  EXPECT_EQ(s.width_factor(0.1f, 0), 1);
  EXPECT_EQ(s.width_factor(0.1f, 0.9f), 0);
}

// Colours that vary are brought closer to their mean by the root of the share [Cook07, eq. 22]; curves may
// move by a tenth of a pixel, which is half as long in the scene for a camera twice as near, or twice the
// quality.
TEST(Simplification, ContrastAndToleranceAreWhatTheySay) {
  const Simplification s = sized();
  for (const float share : {0.01f, 0.25f, 0.81f}) EXPECT_FLOAT_EQ(s.contrast(share), std::sqrt(share));
  EXPECT_FLOAT_EQ(s.tolerance(V3f(0, 0, -100)), 0.1f * 100 / 1000);
  EXPECT_FLOAT_EQ(s.tolerance(V3f(0, 0, -50)), 0.1f * 50 / 1000);
  SimplificationParams params;
  params.quality = 2;
  EXPECT_FLOAT_EQ(Simplification(params, view_from(V3f(0)), kHair, 1).tolerance(V3f(0, 0, -100)),
                  0.05f * 100 / 1000);
  params.fewer_points = params.contrast = false;
  const Simplification off(params, view_from(V3f(0)), kHair, 1);
  EXPECT_EQ(off.tolerance(V3f(0, 0, -100)), 0);
  EXPECT_EQ(off.contrast(0.1f), 1);
}

TEST(Simplification, CoatsOfNothingAreLeftAlone) {
  EXPECT_EQ(share_at(sized({}), 1e5f), 1);
  EXPECT_EQ(share_at(sized({0, 1, 0}), 1e5f), 1);
}

TEST(Simplification, TheHashTellsWhatDecides) {
  SimplificationParams params;
  const ContentHash plain = Simplification(params, view_from(V3f(0)), kHair, 1).hash();
  EXPECT_EQ(plain, Simplification(params, view_from(V3f(0)), kHair, 1).hash());
  EXPECT_FALSE(plain == Simplification(params, view_from(V3f(0, 0, 1e-6f)), kHair, 1).hash());
  EXPECT_FALSE(plain == Simplification(params, view_from(V3f(0)), kHair, 2).hash());
  params.contrast = false;
  EXPECT_FALSE(plain == Simplification(params, view_from(V3f(0)), kHair, 1).hash());
}

}  // namespace
}  // namespace pelage
