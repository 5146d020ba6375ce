// SPDX-License-Identifier: Apache-2.0
#include "render/accel/fur/fur_leaf.h"

#include <cstring>

#include <gtest/gtest.h>

#include "render/accel/fur/fur_grid.h"
#include "render/accel/fur/fur_node.h"
#include "tests/render/accel/fur/fur_grooms.h"

namespace pelage {
namespace {

TEST(FurGrid, step_is_a_power_of_two_that_fits_the_width) {
  for (float width = 1e-6f; width < 1e3f; width *= 1.37f) {
    const FurGrid grid(width);
    int exponent = 0;
    EXPECT_EQ(std::frexp(grid.step(), &exponent), 0.5f);
    EXPECT_GE(width / grid.step(), 192);
    EXPECT_LT(width / grid.step(), 384);
  }
}

TEST(FurGrid, snaps_to_whole_steps_and_once) {
  const FurGrid grid(0.01f);
  TestRandom random(1);
  for (int i = 0; i < 10000; ++i) {
    const float x = random.between(-1, 1) * std::ldexp(1.0f, i % 40 - 10);
    const float snapped = grid.snap(x, 0);
    ASSERT_EQ(snapped, std::round(snapped));
    ASSERT_LE(std::abs((snapped * grid.step()) - x), 0.5f * grid.step());
    ASSERT_EQ(grid.snap((snapped * grid.step()), 0), snapped);
    const float r = random.unit() * 0.005f, snapped_r = grid.snap_radius(r);
    ASSERT_EQ(grid.snap_radius((snapped_r * grid.step())), snapped_r);
    ASSERT_NEAR((snapped_r * grid.step()), r, 0.0075f * std::sqrt(r * 0.005f) + 0.001f * grid.step());
  }
  EXPECT_EQ(grid.snap_radius(-1), 0);
}

TEST(SnappedStrands, number_segments_by_strand_id_and_share_joints) {
  for (const GroomShape& shape : groom_shapes()) {
    const Strands strands = random_groom(shape, 50, 1);
    const SnappedStrands snapped(strands, FurGrid(shape.width));
    uint64_t last_id = 0;
    SnappedSegment last{};
    uint32_t count = 0;
    snapped.for_each_segment([&](uint32_t number, SnappedStrands::Place place) {
      ASSERT_EQ(number, count++);
      const SnappedStrands::Place located = snapped.locate(number);
      ASSERT_EQ(located.strand, place.strand);
      ASSERT_EQ(located.segment, place.segment);
      ASSERT_EQ(snapped.first_segment(place.strand) + place.segment, number);
      ASSERT_GE(strands.id(place.strand), last_id);
      last_id = strands.id(place.strand);
      const SnappedSegment segment = snapped.segment(place, 0);
      if (place.segment > 0) {
        ASSERT_EQ(segment[0], last[3]) << shape.name;
        const bool exact = std::abs(segment[0][0]) < 0x1p23f;
        for (size_t axis = 0; axis < 3 && exact && shape.basis != CurveBasis::kLinear; ++axis)
          ASSERT_EQ(segment[1][axis] - segment[0][axis], last[3][axis] - last[2][axis]) << shape.name;
      }
      last = segment;
    });
    EXPECT_EQ(count, snapped.segment_count());
  }
}

TEST(FurLeaf, narrow_and_wide_blocks_decode_the_same_floats) {
  TestRandom random(1);
  int narrow = 0;
  for (int i = 0; i < 3000; ++i) {
    const int keys = 1 + i % 3;
    const size_t lanes = 1 + static_cast<size_t>(i) % 4;
    const float spread = std::ldexp(1.0f, 4 + i % 15);
    std::vector<SnappedSegment> segments(lanes * static_cast<size_t>(keys));
    for (SnappedSegment& segment : segments) {
      for (auto& p : segment) {
        for (size_t axis = 0; axis < 3; ++axis)
          p[axis] = std::nearbyint(random.between(-1, 1) * spread - 3e5f);
        const float root = std::nearbyint(random.unit() * (i % 50 == 0 ? 400.0f : 255.0f));
        p[3] = root * root / 256;
      }
    }
    FurBlockContents contents;
    contents.segments = segments;
    for (size_t lane = 0; lane < lanes; ++lane) contents.numbers[lane] = static_cast<uint32_t>(lane);
    const bool fits = fits_narrow_block(contents);
    narrow += fits;
    for (const bool wide : {true, false}) {
      if (!wide && !fits) continue;
      std::vector<std::byte> block((wide ? kWideBlock : kNarrowBlock).block(keys));
      write_block(contents, keys, wide, block.data());
      for (size_t lane = 0; lane < lanes; ++lane) {
        for (int key = 0; key < keys; ++key) {
          ASSERT_EQ(read_block(block.data(), wide, lane, key),
                    segments[lane * static_cast<size_t>(keys) + static_cast<size_t>(key)]);
        }
      }
    }
  }
  EXPECT_GT(narrow, 1500);
  EXPECT_LT(narrow, 2990);
}

TEST(FurNode, quantised_boxes_hold_the_boxes) {
  TestRandom random(1);
  for (int i = 0; i < 3000; ++i) {
    const int keys = 1 + i % 3;
    const size_t count = 1 + static_cast<size_t>(i) % 4;
    std::vector<FurBox> boxes(count * static_cast<size_t>(keys));
    const float place = std::ldexp(random.between(-1, 1), i % 30), size = std::ldexp(1.0f, i % 17);
    for (FurBox& box : boxes) {
      for (size_t axis = 0; axis < 3; ++axis) {
        box.low[axis] = place + size * random.unit();
        box.high[axis] = box.low[axis] + (i % 7 == 0 ? 0 : size * random.unit());
      }
    }
    FurChild children[4];
    for (size_t c = 0; c < count; ++c) {
      const std::span<const FurBox> of_child(&boxes[c * static_cast<size_t>(keys)],
                                             static_cast<size_t>(keys));
      children[c] = {FurReference::to_leaf(16 * c, 1, false), of_child};
    }
    std::vector<std::byte> node(FurQuantisedNode::size(keys));
    write_node(keys, std::span(children, count), node.data());
    float origin[3], scale[3];
    std::memcpy(origin, node.data() + FurQuantisedNode::kOrigin, sizeof(origin));
    std::memcpy(scale, node.data() + FurQuantisedNode::kScale, sizeof(scale));
    for (size_t key = 0; key < static_cast<size_t>(keys); ++key) {
      for (size_t axis = 0; axis < 3; ++axis) {
        const std::byte* planes = node.data() + FurQuantisedNode::kPlanes + key * FurQuantisedNode::kKey +
                                  axis * FurQuantisedNode::kAxis;
        for (size_t c = 0; c < count; ++c) {
          const FurBox& box = boxes[c * static_cast<size_t>(keys) + key];
          const auto low = std::to_integer<int>(planes[c]), high = std::to_integer<int>(planes[4 + c]);
          ASSERT_LE(origin[axis] + static_cast<float>(low) * scale[axis], box.low[axis]);
          ASSERT_GE(origin[axis] + static_cast<float>(high) * scale[axis], box.high[axis]);
        }
      }
    }
  }
}

}  // namespace
}  // namespace pelage
