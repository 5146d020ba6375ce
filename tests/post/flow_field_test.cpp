// SPDX-License-Identifier: Apache-2.0
#include "post/flow_field.h"

#include <gtest/gtest.h>

#include "post/warp.h"
#include "tests/post/picture.h"

namespace pelage {
namespace {

TEST(FlowField, LinksWhatIsOneSurface) {
  Picture p(8, 2);
  for (int x = 4; x < 8; ++x) {
    p.depth[p.at(x, 0)] = p.depth[p.at(x, 1)] = 1.2f;  // a step in depth
    p.motion[p.at(x, 0)] = p.motion[p.at(x, 1)] = {static_cast<float>(x), 0};
  }
  p.motion[p.at(7, 0)] = p.motion[p.at(7, 1)] = {20, 0};  // torn off by its motion
  const FlowField field(8, 2, p.motion, p.depth, LinkLimits(), Workers(1));
  for (int x = 0; x < 7; ++x) EXPECT_EQ(field.linked_right(x, 0), x != 3 && x != 6) << x;
  for (int x = 0; x < 8; ++x) EXPECT_TRUE(field.linked_down(x, 0)) << x;
}

TEST(FlowField, PixelsOfOneSurfaceAgreeOnTheirCorners) {
  Picture p(40, 30);
  p.each([&](int, int, size_t i) {
    const uint64_t h = hash64(i, random_use("flow"));
    p.motion[i] = {2 * unit_float(h), 2 * unit_float(h >> 20)};
    p.depth[i] = h % 5 == 0 ? 1.0f : 3.0f;
  });
  const FlowField field(40, 30, p.motion, p.depth, LinkLimits(), Workers(3));
  int linked = 0;
  for (int y = 0; y < 30; ++y) {
    for (int x = 0; x < 39; ++x) {
      if (!field.linked_right(x, y)) continue;
      ++linked;
      EXPECT_EQ(field.corner(x, y, 1, 0), field.corner(x + 1, y, 0, 0));
      EXPECT_EQ(field.corner(x, y, 1, 1), field.corner(x + 1, y, 0, 1));
    }
  }
  EXPECT_GT(linked, 300);
}

TEST(FlowField, AloneAPixelIsRigid) {
  Picture p(3, 3);
  p.motion[4] = {9, 9};
  p.depth[4] = 0.1f;
  const FlowField field(3, 3, p.motion, p.depth, LinkLimits(), Workers(1));
  EXPECT_TRUE(field.is_rigid(1, 1));
  EXPECT_EQ(field.corner(1, 1, 0, 1), (Flow{9, 9}));
  EXPECT_EQ(field.corner(0, 0, 1, 1), (Flow{0, 0}));
}

/// The slow truth: every pixel drawn alone as a polygon, every sample asked.
bool is_inside(const Flow (&p)[4], float x, float y) {
  int crossings = 0;
  const int ring[] = {0, 1, 3, 2};
  for (int k = 0; k < 4; ++k) {
    const Flow a = p[ring[k]], b = p[ring[(k + 1) % 4]];
    if ((a.y <= y) == (b.y <= y)) continue;
    if (a.x + (y - a.y) * (b.x - a.x) / (b.y - a.y) <= x) ++crossings;
  }
  return crossings % 2 == 1;
}

TEST(Warp, DrawsWhatEverySampleWouldAnswer) {
  Picture p(24, 18);
  p.each([&](int x, int y, size_t i) {
    const bool near = (x + y) % 7 < 3;
    p.depth[i] = near ? 1.0f : 2.0f + 0.01f * static_cast<float>(x);
    p.motion[i] =
        near ? Flow{3.3f, 1.7f} : Flow{0.31f * static_cast<float>(y), 0.23f * static_cast<float>(x)};
  });
  const FlowField field(24, 18, p.motion, p.depth, LinkLimits(), Workers(1));
  constexpr int kScale = 4;
  constexpr float kTime = 0.77f;
  const Warp warp(field, {kScale, 0, 0});
  WorkBuffer buffer({0, 0, 24, 18}, kScale);
  for (const FlowField::Block& block : field.blocks()) warp.draw(block, kTime, buffer);
  int different = 0, covered = 0;
  for (int sy = 0; sy < 18 * kScale; ++sy) {
    for (int sx = 0; sx < 24 * kScale; ++sx) {
      Sample truth;
      for (int y = 0; y < 18; ++y) {
        for (int x = 0; x < 24; ++x) {
          Flow corners[4];
          for (int c = 0; c < 4; ++c) {
            const Flow m = field.corner(x, y, c & 1, c >> 1);
            corners[c] = {kScale * (static_cast<float>(x + (c & 1)) + kTime * m.x),
                          kScale * (static_cast<float>(y + (c >> 1)) + kTime * m.y)};
          }
          const Sample sample(field.depth(x, y), x, y);
          if (sample.is_nearer_than(truth) &&
              is_inside(corners, static_cast<float>(sx) + 0.5f, static_cast<float>(sy) + 0.5f)) {
            truth = sample;
          }
        }
      }
      covered += !truth.is_empty();
      different += buffer.row(sy)[sx] != truth;
    }
  }
  EXPECT_GT(covered, 4000);
  EXPECT_LE(different, covered / 500);  // centres on an edge, and quads that are not convex
}

}  // namespace
}  // namespace pelage
