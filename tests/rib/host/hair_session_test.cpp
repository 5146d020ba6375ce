// SPDX-License-Identifier: Apache-2.0
#include "rib/host/hair_session.h"

#include <cmath>
#include <thread>

#include <gtest/gtest.h>

#include "rib/host/hair_node.h"
#include "tests/world/furry_scene.h"

namespace pelage {
namespace {

/// Divides everything at once, without a renderer.
class AllStrands final : public HairOutput {
 public:
  void nested(HairNode node, const Box3f&) override { node.subdivide(*this); }
  void strands(Strands strands, std::span<const float>) override {
    for (size_t i = 0; i < strands.point_count(); ++i)
      sum_of_widths += static_cast<double>(strands.radius(i));
    add_strands(strands, found);
  }
  StrandsById found;
  double sum_of_widths = 0;
};

AllStrands all_of(const std::string& arguments, float detail) {
  HairSessions sessions;
  AllStrands all;
  subdivide_request(sessions, arguments, detail, all);
  return all;
}

std::string coat_of(const FurryScene& files, const std::string& more) {
  return files.scene() + " character=walker coat=coat frame=2 set=render.lod.enabled=true threads=2 " + more;
}

// Law 3.
TEST(HairSession, SceneCameraGivesThePicturesLevelOfDetail) {
  const FurryScene files;
  const std::string far = "'set=camera.position=[30, 20, 80]' ";
  const std::vector<Override> overrides{{"render.lod.enabled", "true"}, {"camera.position", "[30, 20, 80]"}};
  const StrandsById reference = picture_strands(files.scene(), "walker.coat", 2, overrides);
  EXPECT_LT(reference.size(), 800u);
  // Whatever the renderer says.
  for (const float detail : {1e38f, 1e6f, 1.0f})
    EXPECT_EQ(all_of(coat_of(files, far + "camera=scene"), detail).found, reference);
}

TEST(HairSession, DetailThinsOutAndPreservesCoverage) {
  const FurryScene files;
  const AllStrands full = all_of(coat_of(files, ""), 1e38f);
  EXPECT_EQ(full.found.size(), 900u);
  EXPECT_EQ(all_of(coat_of(files, "detail=full"), 1.0f).found, full.found);
  EXPECT_EQ(all_of(coat_of(files, ""), 1e9f).found, full.found);  // strands are wide enough
  StrandsById coarser = full.found;
  for (const float detail : {20000.0f, 5000.0f, 1000.0f}) {
    const AllStrands thin = all_of(coat_of(files, "set=render.lod.fewer_points=false"), detail);
    EXPECT_LT(thin.found.size(), full.found.size());
    EXPECT_GT(thin.found.size(), 0u);
    // A subset of the strands of every finer level.
    for (const auto& [id, strand] : thin.found) EXPECT_TRUE(coarser.contains(id)) << id;
    // The widths of the kept strands replace those of the others; they are fewer where wide strands overlap
    // less.
    EXPECT_LT(thin.sum_of_widths, 1.05 * full.sum_of_widths);
    EXPECT_GT(thin.sum_of_widths, 0.5 * full.sum_of_widths);
    coarser = thin.found;
  }
}

TEST(HairSession, DetailOfTheRequestDecidesForAllItsLeaves) {
  const FurryScene files;
  const AllStrands whole = all_of(coat_of(files, ""), 2000.0f);
  EXPECT_LT(whole.found.size(), 900u);
  // The same with smaller leaves: neither boxes nor leaves matter.
  EXPECT_EQ(all_of(coat_of(files, "set=grooms.coat.leaf_strands=200"), 2000.0f).found.size(),
            whole.found.size());
}

TEST(HairSession, IsSharedByRequestsOfTheSameScene) {
  const FurryScene files;
  HairSessions sessions;
  const HairArguments one = parse_hair_arguments(coat_of(files, "leaf=1"));
  const auto first = sessions.of(one);
  EXPECT_EQ(first, sessions.of(parse_hair_arguments(coat_of(files, "leaf=2 camera=scene"))));
  const auto other = sessions.of(parse_hair_arguments(coat_of(files, "set=render.seed=3")));
  EXPECT_NE(first, other);
  EXPECT_EQ(first, sessions.of(one));  // it still has an owner
  EXPECT_EQ(first->frame(2, "walker"), first->frame(2, "walker"));
  EXPECT_NE(first->frame(2, "walker"), first->frame(1, "walker"));
}

TEST(HairSession, ARequestNamesNoFolderToWriteInto) {
  const FurryScene files;
  const HairSession session(parse_hair_arguments(coat_of(
      files, "'set=render.bvh={file: trees}' 'set=grooms.coat.cache={directory: stolen, freeze: width}'")));
  EXPECT_TRUE(session.scene().render.bvh.file.empty());
  EXPECT_EQ(session.scene().grooms.find("coat")->value.cache->directory.path, "cache");
  EXPECT_FALSE(std::filesystem::exists("stolen"));
  EXPECT_EQ(session.scene().warnings.size(), 2u);
}

TEST(HairSession, LeavesWaitForMemory) {
  const FurryScene files;
  const HairArguments arguments = parse_hair_arguments(coat_of(files, "memory=20M"));
  const HairSession session(arguments);
  const auto frame = session.frame(2, "walker");
  const auto tree = session.tree(*frame, 0, {});
  std::vector<StrandsById> grown(6);
  std::vector<std::thread> threads;
  for (StrandsById& mine : grown) {
    threads.emplace_back([&] {
      for (size_t leaf = 0; leaf < tree->all().end; ++leaf) add_strands(session.grow(*tree, leaf), mine);
    });
  }
  for (std::thread& thread : threads) thread.join();
  for (const StrandsById& mine : grown) EXPECT_EQ(mine, grown[0]);
  EXPECT_EQ(grown[0].size(), 900u);
}

}  // namespace
}  // namespace pelage
