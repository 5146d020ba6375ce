// SPDX-License-Identifier: Apache-2.0
#include "cli/leaf_sizes.h"

#include <gtest/gtest.h>

namespace pelage {
namespace {

constexpr uint64_t kMiB = uint64_t(1) << 20;

SceneDescription scene_of(GroomParams groom, uint64_t memory) {
  SceneDescription scene;
  scene.render.memory.bytes = memory;
  scene.grooms.items.push_back({"coat", {}, std::move(groom)});
  choose_leaf_sizes(scene);
  return scene;
}

int leaf_size(const GroomParams& groom, uint64_t memory) {
  return scene_of(groom, memory).grooms.items[0].value.leaf_size();
}

TEST(LeafSizes, FollowTheMemoryLimitInFewSteps) {
  EXPECT_EQ(leaf_size({}, 4096 * kMiB), 8000);
  EXPECT_EQ(leaf_size({}, 1024 * kMiB), 2000);
  EXPECT_EQ(leaf_size({}, 1500 * kMiB), 2000);
  EXPECT_EQ(leaf_size({}, 512 * kMiB), 500);
  EXPECT_EQ(leaf_size({}, 80 * kMiB), 125);
  EXPECT_EQ(leaf_size({}, 1), 125);
}

TEST(LeafSizes, AreTheLargestWithoutALimit) { EXPECT_EQ(leaf_size({}, 0), 8000); }

TEST(LeafSizes, AreSmallerWhereStrandsAreLarger) {
  GroomParams groom;
  groom.points = 64;
  EXPECT_EQ(leaf_size(groom, 1024 * kMiB), 125);
}

TEST(LeafSizes, AreWhatTheSceneSays) {
  GroomParams groom;
  groom.leaf_strands = 8000;
  EXPECT_EQ(leaf_size(groom, 64 * kMiB), 8000);
}

TEST(LeafSizes, DoNotFollowTheLimitWhereACacheBelongsToThem) {
  GroomParams groom;
  groom.cache.emplace();
  EXPECT_EQ(leaf_size(groom, 64 * kMiB), 8000);
}

}  // namespace
}  // namespace pelage
