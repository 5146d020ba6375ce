// SPDX-License-Identifier: Apache-2.0
#include "render/accel/fur/fur_frame.h"

#include <gtest/gtest.h>

#include "render/accel/fur/fur_node.h"
#include "tests/render/accel/fur/fur_grooms.h"

namespace pelage {
namespace {

const FurGrid kGrid(0.02f);

/// Nearly straight strands along a direction.
Strands combed(const V3f& direction, float disorder) {
  TestRandom random(3);
  StrandArrays a;
  a.first_point.push_back(0);
  for (uint32_t s = 0; s < 200; ++s) {
    const V3f root = random.unit3();
    const V3f along = (direction + disorder * random.direction()).normalized();
    for (int i = 0; i < 6; ++i) {
      const V3f p = root + (0.2f * static_cast<float>(i)) * along;
      a.points.insert(a.points.end(), {p.x, p.y, p.z, 0.01f});
    }
    a.first_point.push_back(a.first_point.back() + 6);
    a.ids.push_back(s);
  }
  return Strands(std::move(a));
}

FurFrame frame_of(const Strands& strands, FurRotation rotation = FurRotation::kWhenUseful) {
  return choose_frame(SnappedStrands(strands, kGrid), rotation);
}

TEST(FurFrame, stands_along_combed_strands) {
  const V3f direction = V3f(2, -1, 1.5f).normalized();
  const FurFrame frame = frame_of(combed(direction, 0.05f));
  ASSERT_TRUE(frame.turned);
  EXPECT_GT(std::abs(frame.axes[2].dot(direction)), 0.99f);
  for (size_t i = 0; i < 3; ++i) {
    EXPECT_NEAR(frame.axes[i].length(), 1, 1e-6f);
    EXPECT_NEAR(frame.axes[i].dot(frame.axes[(i + 1) % 3]), 0, 1e-6f);
  }
}

TEST(FurFrame, is_that_of_the_grid_where_no_other_is_much_better) {
  EXPECT_FALSE(frame_of(combed(V3f(2, -1, 1.5f).normalized(), 5)).turned);
  EXPECT_FALSE(frame_of(combed(V3f(0, 1, 0), 0.05f)).turned);
  EXPECT_FALSE(frame_of(Strands()).turned);
  const Strands diagonal = combed(V3f(1, 1, 1).normalized(), 0.05f);
  EXPECT_TRUE(frame_of(diagonal).turned);
  EXPECT_FALSE(frame_of(diagonal, FurRotation::kNever).turned);
  GroomShape moving = groom_shapes()[9];
  EXPECT_FALSE(frame_of(random_groom(moving, 50, 1), FurRotation::kAlways).turned);
}

TEST(FurFrame, is_told_by_all_parts_of_strands_however_many_segments_they_have) {
  const V3f direction = V3f(1, 1, 1).normalized();
  const auto half_combed = [&](uint32_t segments, bool roots) {
    TestRandom random(5);
    StrandArrays a;
    a.basis = CurveBasis::kLinear;
    a.first_point.push_back(0);
    for (uint32_t s = 0; s < 1024; ++s) {
      V3f p = random.unit3();
      for (uint32_t i = 0; i <= segments; ++i) {
        a.points.insert(a.points.end(), {p.x, p.y, p.z, 0.01f});
        const V3f disorder = random.direction();
        p += 0.2f * ((i == 0) == roots ? direction : disorder);
      }
      a.first_point.push_back(a.first_point.back() + segments + 1);
      a.ids.push_back(s);
    }
    return Strands(std::move(a));
  };
  // Regular sampling of every n-th segment would see only the first ones of strands with n segments.
  for (uint32_t segments : {7u, 8u, 14u}) {
    EXPECT_FALSE(frame_of(half_combed(segments, true)).turned) << segments;
    EXPECT_TRUE(frame_of(half_combed(segments, false)).turned) << segments;
  }
}

TEST(FurFrame, boxes_along_the_grid_hold_those_that_are_turned) {
  TestRandom random(4);
  for (int i = 0; i < 200; ++i) {
    const FurFrame frame = frame_of(combed(random.direction(), 0.1f), FurRotation::kAlways);
    ASSERT_TRUE(frame.turned && frame.is_possible());
    const float place = std::ldexp(random.between(-1, 1), i % 24);
    FurBox box;
    for (size_t axis = 0; axis < 3; ++axis) {
      box.low[axis] = place + random.unit();
      box.high[axis] = box.low[axis] + 100 * random.unit();
    }
    const FurBox grid = frame.unrotated(box);
    for (int corner = 0; corner < 8; ++corner) {
      V3d p(0);
      for (int axis = 0; axis < 3; ++axis) {
        const auto a = static_cast<size_t>(axis);
        p += double(corner >> axis & 1 ? box.high[a] : box.low[a]) * V3d(frame.axes[a]);
      }
      for (size_t axis = 0; axis < 3; ++axis) {
        ASSERT_LE(grid.low[axis], p[static_cast<int>(axis)]);
        ASSERT_GE(grid.high[axis], p[static_cast<int>(axis)]);
      }
    }
  }
}

}  // namespace
}  // namespace pelage
