// SPDX-License-Identifier: Apache-2.0
#include "world/leaf_sizes.h"

#include <gtest/gtest.h>

#include "base/temporary_folder.h"
#include "geom/io/strand_file.h"

namespace pelage {
namespace {

constexpr uint64_t kMiB = uint64_t(1) << 20;

/// A character with one coat, and a crowd of two more.
SceneDescription scene_of(GroomParams groom) {
  SceneDescription scene;
  CharacterParams character;
  character.parts.emplace_back().grooms.items.push_back({"coat", {}, {}});
  scene.characters.items.push_back({"one", {}, character});
  CrowdParams crowd;
  crowd.of.push_back({"one", {}});
  crowd.count = 2;
  scene.crowds.items.push_back({"two", {}, crowd});
  scene.grooms.items.push_back({"coat", {}, std::move(groom)});
  return scene;
}

int leaf_size(const GroomParams& groom, uint64_t memory) {
  SceneDescription scene = scene_of(groom);
  scene.render.memory.bytes = memory;
  choose_leaf_sizes(scene);
  return scene.grooms.items[0].value.leaf_size();
}

TEST(LeafSizes, FollowTheMemoryLimitInFewSteps) {
  EXPECT_EQ(leaf_size({}, 4096 * kMiB), 8000);
  EXPECT_EQ(leaf_size({}, 1024 * kMiB), 2000);
  EXPECT_EQ(leaf_size({}, 1500 * kMiB), 2000);
  EXPECT_EQ(leaf_size({}, 256 * kMiB), 500);
  EXPECT_EQ(leaf_size({}, 80 * kMiB), 125);
  EXPECT_EQ(leaf_size({}, 1), 125);
}

TEST(LeafSizes, AreSmallerWhereStrandsAreLarger) {
  GroomParams groom;
  groom.points = 64;
  EXPECT_EQ(leaf_size(groom, 1024 * kMiB), 500);
}

TEST(LeafSizes, AreTheLargestWhereAllFurFits) {
  GroomParams groom;
  groom.strands = 100000;  // of 8 points: 64 MB for each of three animals
  EXPECT_EQ(leaf_size(groom, 200 * kMiB), 8000);
  EXPECT_EQ(leaf_size(groom, 180 * kMiB), 500);
}

TEST(LeafSizes, AreTheLargestWithoutALimit) { EXPECT_EQ(leaf_size({}, 0), 8000); }

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

GroomParams of_file(const std::filesystem::path& path, uint32_t strands, uint32_t points) {
  StrandArrays arrays;
  arrays.first_point = {0};
  for (uint32_t s = 0; s < strands; ++s) {
    for (uint32_t p = 0; p < points; ++p)
      arrays.points.insert(arrays.points.end(), {float(s), float(p), 0, 0.1f});
    arrays.first_point.push_back((s + 1) * points);
    arrays.ids.push_back(s);
  }
  write_strands(path, Strands(std::move(arrays)));
  GroomParams groom;
  groom.strands_file.path = path;
  return groom;
}

TEST(LeafSizes, FollowTheStrandsOfAFile) {
  const TemporaryFolder folder;
  const GroomParams coat = of_file(folder.path() / "short.hair", 60'000, 8);
  EXPECT_EQ(leaf_size(coat, 8192 * kMiB), 8000);
  EXPECT_EQ(leaf_size(coat, 64 * kMiB), 2000);
  const GroomParams strings = of_file(folder.path() / "long.hair", 300, 1024);
  EXPECT_EQ(leaf_size(strings, 0), 8000);
  EXPECT_EQ(leaf_size(strings, 512 * kMiB), 500);  // all fits, but growing all of it at once would not
  EXPECT_EQ(leaf_size(strings, 32 * kMiB), 7);
  GroomParams missing;
  missing.strands_file.path = folder.path() / "none.hair";
  EXPECT_EQ(leaf_size(missing, 8192 * kMiB), 8000);
}

TEST(LeafSizes, AreFewVeryLongStrands) {
  GroomParams groom;
  groom.points = 1024;
  EXPECT_EQ(leaf_size(groom, 64 * kMiB), 7);
}

TEST(LeafSizes, DoNotFollowTheLimitWhereTreesAreKept) {
  for (const uint64_t memory : {uint64_t(0), 80 * kMiB, 4096 * kMiB}) {
    SceneDescription scene = scene_of({});
    scene.render.memory.bytes = memory;
    scene.render.bvh.file.path = "trees";
    choose_leaf_sizes(scene);
    EXPECT_EQ(scene.grooms.items[0].value.leaf_size(), 500);
  }
}

}  // namespace
}  // namespace pelage
