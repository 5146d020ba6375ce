// SPDX-License-Identifier: Apache-2.0
#include "rib/host/coat_tree.h"

#include <gtest/gtest.h>

#include "geom/curve_bounds.h"
#include "geom/rest_position.h"
#include "tests/world/furry_scene.h"

namespace pelage {
namespace {

class CoatTrees : public testing::Test {
 protected:
  CoatTrees()
      : scene_(load_scene(files_.scene())),
        assets_(load_assets(scene_, job_)),
        parts_(pose_frame(scene_, *assets_, 2, job_)),
        tree_(parts_.coats[0], {}) {}

  const FurryScene files_;
  QuietJob job_;
  const SceneDescription scene_;
  std::unique_ptr<Assets> assets_;
  const FrameParts parts_;
  const CoatTree tree_;
};

TEST_F(CoatTrees, PartsAreTheWhole) {
  ASSERT_GT(tree_.all().count(), 10u);
  for (size_t first = 0; first < tree_.all().end; ++first) {
    for (size_t end = first + 2; end <= tree_.all().end; ++end) {
      const std::vector<LeafRange> parts = tree_.split({first, end});
      ASSERT_GE(parts.size(), 2u);
      ASSERT_LE(parts.size(), 8u);
      EXPECT_EQ(parts.front().first, first);
      EXPECT_EQ(parts.back().end, end);
      for (size_t i = 0; i < parts.size(); ++i) {
        EXPECT_GT(parts[i].count(), 0u);
        if (i > 0) {
          EXPECT_EQ(parts[i].first, parts[i - 1].end);
        }
      }
    }
  }
}

// Every box is enlarged by 2^-21 of its largest coordinate (geom/curve_bounds.h): the boxes of parts and the
// box of all strands. So they differ by at most twice this amount.
TEST_F(CoatTrees, BoxesContainTheStrandsAndAreTight) {
  Box3f all;
  for (size_t leaf = 0; leaf < tree_.all().end; ++leaf) {
    const Box3f exact = exact_bounds(tree_.leaf(leaf).generate()), box = tree_.box({leaf, leaf + 1}, job_);
    for (int axis = 0; axis < 3; ++axis) {
      const float rounding = 0x1p-20f * 8;  // no coordinate is larger than 8
      EXPECT_NEAR(box.min[axis], exact.min[axis], rounding);
      EXPECT_NEAR(box.max[axis], exact.max[axis], rounding);
    }
    all.extendBy(box);
  }
  EXPECT_EQ(tree_.box(tree_.all(), job_), all);
}

// The same values that a field of the picture's own coat gets.
TEST_F(CoatTrees, StrandsOfAMovedSkinKnowTheirPlacesAtRest) {
  const Strands strands = tree_.grow(0);
  for (size_t s = 0; s < strands.strand_count(); ++s) {
    const RootAddress& root = strands.root(s);
    EXPECT_EQ(rest_position(strands, s), parts_.coats[0].rest->evaluate(root.face, root.u, root.v).position);
  }
  ASSERT_TRUE(parts_.coats[1].at_rest);
  EXPECT_FALSE(rest_position(CoatTree(parts_.coats[1], {}).grow(0), 0)) << "the still character needs none";
}

TEST_F(CoatTrees, MemoryOfALeafIsCountedBeforeItGrows) {
  for (size_t leaf = 0; leaf < tree_.all().end; ++leaf)
    EXPECT_GE(tree_.growth_bytes(leaf), static_cast<int64_t>(tree_.grow(leaf).bytes()));
}

}  // namespace
}  // namespace pelage
