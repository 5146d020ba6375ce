// SPDX-License-Identifier: Apache-2.0
// The three measures against what a camera does, taken apart ray by ray.
#include "lod/lod_view.h"

#include <algorithm>
#include <cmath>
#include <vector>

#include <gtest/gtest.h>

#include "base/hash.h"

namespace pelage {
namespace {

class Random {
 public:
  explicit Random(uint64_t seed) : seed_(seed) {}
  float next() { return signed_float(hash64(seed_, draw_++)); }
  V3f vector() {
    const float x = next(), y = next();
    return {x, y, next()};
  }

 private:
  uint64_t seed_, draw_ = 0;
};

LodPose pose(const V3f& position, const V3f& look_at) {
  LodPose p;
  p.position = position;
  p.forward = (look_at - position).normalized();
  p.right = p.forward.cross(V3f(0, 1, 0)).normalized();
  p.up = p.right.cross(p.forward);
  p.focal_pixels = 500;
  return p;
}

V2f project(const LodPose& p, const V3f& point) {
  const V3f d = point - p.position;
  return V2f(d.dot(p.right), d.dot(p.up)) * (p.focal_pixels / d.dot(p.forward));
}

TEST(LodMeasures, SizeIsThatOfASmallLengthAcrossTheView) {
  Random random(1);
  LodView view;
  view.open = view.close = pose({1, 2, 3}, {0, 0, 0});
  for (int i = 0; i < 100; ++i) {
    const V3f point = view.open.position + view.open.forward * (20 + 10 * random.next());
    const V2f moved = project(view.open, point + 0.01f * view.open.right) - project(view.open, point);
    EXPECT_NEAR(pixels_per_unit(view, point) * 0.01f, moved.length(), 2e-3f * moved.length());
  }
  // Behind the camera as in front of it; never infinite.
  EXPECT_EQ(pixels_per_unit(view, view.open.position + view.open.forward),
            pixels_per_unit(view, view.open.position - view.open.forward));
  EXPECT_EQ(pixels_per_unit(view, view.open.position), 500 / view.near_distance);
}

TEST(LodMeasures, MotionIsThatInThePicture) {
  Random random(2);
  for (int i = 0; i < 200; ++i) {
    LodView view;
    const V3f at = 3.0f * random.vector(), look = V3f(0, 0, -30) + random.vector();
    view.open = pose(at, look);
    // A camera that moves and turns a little, and a point that moves on its own, near the axis.
    view.close = pose(at + 0.2f * random.vector(), look + 0.2f * random.vector());
    const V3f open = view.open.position + 30.0f * view.open.forward + random.vector();
    const V3f close = open + 0.3f * random.vector();
    const float seen = (project(view.close, close) - project(view.open, open)).length();
    const float measured = motion_across(view, open, close) * pixels_per_unit(view, open);
    EXPECT_NEAR(measured, seen, 0.02f * seen + 0.05f);
  }
}

TEST(LodMeasures, MotionAlongTheViewDoesNotBlur) {
  LodView view;
  view.open = view.close = pose({0, 0, 10}, {0, 0, 0});
  EXPECT_NEAR(motion_across(view, {0, 0, 0}, {0, 0, 3}), 0, 1e-6);
  EXPECT_NEAR(motion_across(view, {0, 0, 0}, {0, 2, 3}), 2, 1e-5);
  // A point that moves with the camera has no motion; a fixed one moves relative to it.
  view.close = pose({1, 0, 10}, {1, 0, 0});
  EXPECT_NEAR(motion_across(view, {0, 0, 0}, {1, 0, 0}), 0, 1e-6);
  EXPECT_NEAR(motion_across(view, {0, 0, 0}, {0, 0, 0}), 1, 1e-6);
}

TEST(LodMeasures, MotionAcrossALineIsHowFarItsPictureMovesSideways) {
  Random random(3);
  for (int i = 0; i < 200; ++i) {
    LodView view;
    const V3f at = 3.0f * random.vector(), look = V3f(0, 0, -300) + random.vector();
    view.open = pose(at, look);
    view.close = pose(at + 0.2f * random.vector(), look + 0.2f * random.vector());
    // A line in the plane of the picture, near the axis, so that it is seen at its full length.
    const V3f open = view.open.position + 30.0f * view.open.forward + 0.1f * random.vector();
    const V3f close = open + random.vector();
    const float angle = 3.14159265f * random.next();
    const V3f line = std::cos(angle) * view.open.right + std::sin(angle) * view.open.up;
    const V2f moved = project(view.close, close) - project(view.open, open);
    const float sideways = std::abs(moved.dot(V2f(-std::sin(angle), std::cos(angle))));
    const float measured = motion_across_line(view, open, close, line) * pixels_per_unit(view, open);
    EXPECT_NEAR(measured, sideways, 0.05f * moved.length() + 0.05f);
    const float all = motion_across(view, open, close);
    EXPECT_NEAR(motion_across_line(view, open, close, V3f(0)), all, 1e-5f);
    EXPECT_NEAR(motion_across_line(view, open, close, view.open.forward), all, 0.01f * all);
  }
}

TEST(LodMeasures, SkinFacesTheCameraThatItsNormalPointsTo) {
  LodView view;
  view.open.position = V3f(0, 0, 10);
  EXPECT_FLOAT_EQ(facing(view, {0, 0, 0}, {0, 0, 1}), 1);
  EXPECT_FLOAT_EQ(facing(view, {0, 0, 20}, {0, 0, 1}), -1);
  EXPECT_FLOAT_EQ(facing(view, {0, 10, 0}, {0, -1, 0}), std::sqrt(0.5f));
  EXPECT_EQ(facing(view, {0, 0, 0}, V3f(0)), 1);
}

TEST(LodMeasures, ConfusionIsWhereALensSmearsAPoint) {
  LodView view;
  view.open = view.close = pose({0, 1, 5}, {0, 0, -3});
  view.lens_diameter = 0.7f;
  view.focus_distance = 9;
  const LodPose& p = view.open;
  for (const float depth : {0.5f, 4.0f, 8.9f, 9.0f, 12.0f, 300.0f}) {
    const V3f point = p.position + p.forward * depth + p.right * 0.2f;
    // All rays from the lens that meet the plane in focus where the ray through the middle and the point
    // does: how far apart do they meet the plane of the point?
    const V3f focus = p.position + (point - p.position) * (view.focus_distance / depth);
    float widest = 0;
    for (int i = 0; i < 360; ++i) {
      const float angle = static_cast<float>(i) * 0.0174532925f;
      const V3f lens = p.position + (std::cos(angle) * p.right + std::sin(angle) * p.up) * (0.5f * 0.7f);
      const V3f there = lens + (focus - lens) * (depth / view.focus_distance);
      widest = std::max(widest, 2 * (there - point).length());
    }
    EXPECT_NEAR(confusion_diameter(view, point), widest, 1e-4f * widest + 1e-5f) << depth;
  }
  view.lens_diameter = 0;
  EXPECT_EQ(confusion_diameter(view, V3f(0, 0, -50)), 0);
}

}  // namespace
}  // namespace pelage
