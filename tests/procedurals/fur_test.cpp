// SPDX-License-Identifier: Apache-2.0
#include "procedurals/fur.h"

#include <gtest/gtest.h>

#include "base/parallel.h"
#include "geom/curve_bounds.h"
#include "image/texture_library.h"
#include "tests/groom/shapes.h"
#include "tests/groom/stacks.h"
#include "tests/support/quiet_job.h"

namespace pelage {
namespace {

// A coat of some thousand strands on a ball that moves and swells while the shutter is open.
class FurTest : public testing::Test {
 protected:
  FurTest() : workers_(2), textures_(ledger_) {
    const ControlMesh cage = shapes::ball_cage(12);
    const auto rest = shapes::surface_of(cage);
    GroomParams params;
    params.skin.name = "ball";
    params.strands = 3000;
    params.leaf_strands = 700;
    params.points = 6;
    params.operators = stacks::usual();
    groom_ = Groom::create("coat", params, rest, textures_, QuietJob(2, ledger_));

    CharacterPose pose;
    pose.topology = rest->shared_topology();
    const auto add = [&](PosedCages& cages, float t) {
      cages.cages.push_back(cage.positions);
      for (V3f& p : cages.cages.back()) p = p * (1 + 0.2f * t) + V3f(3 * t, t, 0);
      cages.transforms.emplace_back();
    };
    for (float t : {0.0f, 1.0f}) add(pose.shutter, t);
    for (float t : {-1.0f, 2.0f}) add(pose.frame_ends, t);
    pose.scale = 1.5f;
    skin_ = std::make_shared<PosedCharacterSkin>(std::move(pose), std::make_shared<PoseCache>(2, ledger_));
  }

  Workers workers_;
  MemoryLedger ledger_;
  TextureLibrary textures_;
  std::shared_ptr<const Groom> groom_;
  std::shared_ptr<const PosedCharacterSkin> skin_;
};

bool contains(const Box3f& outer, const Box3f& inner) {
  return outer.intersects(inner.min) && outer.intersects(inner.max);
}

TEST_F(FurTest, SplitsIntoLeavesThatTogetherAreTheCoat) {
  const FurProcedural fur(groom_, skin_);
  const auto leaves = fur.split();
  ASSERT_GT(leaves.size(), 3u);
  const Strands whole = fur.generate();
  EXPECT_EQ(whole.strand_count(), groom_->follicles().size());

  std::vector<bool> seen(whole.strand_count(), false);
  for (const auto& leaf : leaves) {
    EXPECT_TRUE(leaf->split().empty());
    const Strands strands = leaf->generate();
    for (size_t i = 0; i < strands.strand_count(); ++i) {
      const uint64_t id = strands.id(i);  // merged batches are in order of ids, which count from 0
      ASSERT_LT(id, seen.size());
      EXPECT_FALSE(seen[id]);
      seen[id] = true;
      ASSERT_EQ(whole.id(id), id);
      const uint32_t last = strands.first_point(i) + strands.strand_points(i) - 1;
      const uint32_t whole_last = whole.first_point(id) + whole.strand_points(id) - 1;
      for (int key = 0; key < 2; ++key) EXPECT_EQ(strands.point(last, key), whole.point(whole_last, key));
    }
  }
}

TEST_F(FurTest, BoundsHoldEveryPointOverTheShutter) {
  const FurProcedural fur(groom_, skin_);
  const Box3f frame = fur.bound(BoundSpan::kFrame), shutter = fur.bound(BoundSpan::kShutter);
  EXPECT_TRUE(contains(frame, shutter));
  EXPECT_GT(frame.size().x, shutter.size().x + 5);  // it goes on moving before and after the shutter
  for (const auto& leaf : fur.split()) {
    const Box3f box = leaf->bound(BoundSpan::kShutter);
    EXPECT_TRUE(contains(shutter, box));
    EXPECT_TRUE(contains(box, exact_bounds(leaf->generate())));
    EXPECT_TRUE(contains(leaf->bound(BoundSpan::kFrame), box));
  }
}

TEST_F(FurTest, CountsWhatItWillGrow) {
  const FurProcedural fur(groom_, skin_);
  StrandCounts sum;
  for (const auto& leaf : fur.split()) {
    const StrandCounts counts = leaf->counts();
    const Strands strands = leaf->generate();
    EXPECT_EQ(counts.strands, strands.strand_count());
    EXPECT_EQ(counts.points, strands.point_count());
    EXPECT_EQ(counts.longest, strands.strand_points(0));
    EXPECT_EQ(counts.segments, strands.point_count() - strands.strand_count());
    EXPECT_EQ(counts.motion_keys, 2u);
    size_t floats = 0;
    for (const StrandAttribute& a : strands.attributes()) floats += a.values.size();
    EXPECT_EQ(counts.attribute_floats, floats);
    sum += counts;
  }
  EXPECT_EQ(sum.strands, fur.counts().strands);
  EXPECT_EQ(sum.attribute_floats, fur.counts().attribute_floats);
}

TEST_F(FurTest, SameBytesEveryTime) {
  const auto leaves = FurProcedural(groom_, skin_).split();
  const Strands once = leaves[1]->generate(), again = leaves[1]->generate();
  ASSERT_EQ(once.point_count(), again.point_count());
  EXPECT_EQ(once.arrays().points, again.arrays().points);
}

TEST_F(FurTest, HasTheMotionKeysOfItsSkin) {
  const Strands strands = FurProcedural(groom_, skin_).split()[0]->generate();
  ASSERT_EQ(strands.motion_keys(), 2);
  // Roots ride on the limit surface of each key.
  for (size_t i = 0; i < strands.strand_count(); i += 50) {
    const RootAddress& root = strands.root(i);
    for (int key = 0; key < 2; ++key) {
      const V3f on_skin = skin_->pose(BoundSpan::kShutter)
                              ->keys[static_cast<size_t>(key)]
                              .evaluate(root.face, root.u, root.v)
                              .position;
      EXPECT_LT((strands.point(strands.first_point(i), key) - on_skin).length(), 1e-4f);
    }
  }
}

}  // namespace
}  // namespace pelage
