// SPDX-License-Identifier: Apache-2.0
#include "procedurals/skin/posed_character_skin.h"

#include <algorithm>

#include <gtest/gtest.h>

#include "base/parallel.h"
#include "groom/groom.h"
#include "image/texture_library.h"
#include "tests/groom/shapes.h"
#include "tests/support/quiet_job.h"

namespace pelage {
namespace {

// A ball that moves and swells; every frame a new cage.
class PosedCharacterSkinTest : public testing::Test {
 protected:
  CharacterPose pose(float shift = 0, bool open = true, bool push_out = false) const {
    CharacterPose result;
    result.topology = topology_;
    const auto add = [&](PosedCages& cages, float t) {
      cages.cages.push_back(cage_.positions);
      for (V3f& p : cages.cages.back()) p = p * (1 + 0.2f * t) + V3f(3 * t + shift, t, 0);
      cages.transforms.emplace_back();
    };
    for (float t : {0.0f, 1.0f}) {
      if (t == 0 || open) add(result.shutter, t);
    }
    for (float t : {-1.0f, 2.0f}) {
      if (open) add(result.frame_ends, t);
    }
    if (push_out) result.push_out_view = view_;
    return result;
  }
  std::shared_ptr<PosedCharacterSkin> skin(CharacterPose pose) const {
    return std::make_shared<PosedCharacterSkin>(std::move(pose), poses_);
  }

  ControlMesh cage_ = shapes::ball_cage(2);
  std::shared_ptr<const SurfaceTopology> topology_ = shapes::topology_of(cage_);
  View view_{V3f(0, 0, 20), 400};
  MemoryLedger ledger_;
  std::shared_ptr<PoseCache> poses_ = std::make_shared<PoseCache>(2, ledger_);
};

TEST_F(PosedCharacterSkinTest, TheShuttersKeysStandBetweenTheEndsOfTheFrame) {
  const auto moving = skin(pose());
  const auto shutter = moving->pose(BoundSpan::kShutter), frame = moving->pose(BoundSpan::kFrame);
  ASSERT_EQ(shutter->keys.size(), 2u);
  ASSERT_EQ(frame->keys.size(), 4u);
  for (size_t key = 0; key < 2; ++key) {
    EXPECT_EQ(shutter->keys[key].evaluate(3, 0.3f, 0.4f).position,
              frame->keys[key + 1].evaluate(3, 0.3f, 0.4f).position);
  }
  const float x[4] = {-3, 0, 3, 6};
  for (size_t key = 0; key < 4; ++key)
    EXPECT_NEAR(frame->keys[key].control_bounds().center().x, x[key], 1e-5);
}

TEST_F(PosedCharacterSkinTest, AClosedShutterIsOneInstant) {
  const auto still = skin(pose(0, false));
  EXPECT_EQ(still->pose(BoundSpan::kFrame), still->pose(BoundSpan::kShutter));
  EXPECT_EQ(still->motion_keys(), 1);
  EXPECT_EQ(still->bound(BoundSpan::kFrame), still->bound(BoundSpan::kShutter));
}

TEST_F(PosedCharacterSkinTest, BoundsHoldAndCountsAreExact) {
  const auto moving = skin(pose());
  const SkinMesh mesh = moving->tessellate({}, view_);
  const Box3f shutter = moving->bound(BoundSpan::kShutter), frame = moving->bound(BoundSpan::kFrame);
  for (int key = 0; key < 2; ++key) {
    for (size_t i = 0; i < mesh.vertex_count(); ++i) EXPECT_TRUE(shutter.intersects(mesh.position(i, key)));
  }
  EXPECT_LT(frame.min.x, shutter.min.x - 2);
  EXPECT_GT(frame.max.x, shutter.max.x + 2);
  for (const size_t max : {size_t(1), SIZE_MAX}) {
    size_t triangles = 0;
    for (const SkinPiece& piece : moving->divide(view_, max, QuietJob(1))) {
      const SkinMesh part = moving->tessellate(piece, view_);
      EXPECT_EQ(piece.vertices, part.vertex_count());
      EXPECT_EQ(piece.triangles, part.triangle_count());
      triangles += part.triangle_count();
      const Box3f box = moving->bound(piece, BoundSpan::kShutter);
      for (int key = 0; key < 2; ++key) {
        for (size_t i = 0; i < part.vertex_count(); ++i) EXPECT_TRUE(box.intersects(part.position(i, key)));
      }
    }
    EXPECT_EQ(triangles, mesh.triangle_count());
  }
}

TEST_F(PosedCharacterSkinTest, HairKeepsClearOfTheSameTrianglesOverEitherSpan) {
  const auto pushed = skin(pose(0, true, true));
  const auto shutter = pushed->pose(BoundSpan::kShutter), frame = pushed->pose(BoundSpan::kFrame);
  ASSERT_EQ(shutter->trees.size(), 2u);
  ASSERT_EQ(frame->trees.size(), 4u);
  EXPECT_EQ(shutter->mesh->triangles, frame->mesh->triangles);
  EXPECT_EQ(shutter->mesh->triangles, pushed->tessellate({}, view_).triangles);
  for (size_t key = 0; key < 2; ++key) {
    ClosestPoint a, b;
    ASSERT_TRUE(shutter->trees[key].closest(V3f(1, 5, 2), 100, a));
    ASSERT_TRUE(frame->trees[key + 1].closest(V3f(1, 5, 2), 100, b));
    EXPECT_EQ(a.position, b.position);
  }
}

TEST_F(PosedCharacterSkinTest, EqualPosesHaveEqualHashes) {
  EXPECT_EQ(skin(pose())->hash(), skin(pose())->hash());
  EXPECT_NE(skin(pose())->hash(), skin(pose(1e-6f))->hash());
  EXPECT_NE(skin(pose())->hash(), skin(pose(0, false))->hash());
  EXPECT_NE(skin(pose())->hash(), skin(pose(0, true, true))->hash());
  CharacterPose scaled = pose();
  scaled.scale = 2;
  EXPECT_NE(skin(std::move(scaled))->hash(), skin(pose())->hash());
  CharacterPose turned = pose();
  turned.shutter.transforms[1][3][0] = 1;
  EXPECT_NE(skin(std::move(turned))->hash(), skin(pose())->hash());
}

TEST_F(PosedCharacterSkinTest, KeepsAsManyPosesAsThreads) {
  std::vector<std::shared_ptr<PosedCharacterSkin>> skins;
  for (int i = 0; i < 3; ++i) skins.push_back(skin(pose(static_cast<float>(i))));
  std::weak_ptr<const SkinPose> seen[3];
  for (size_t i = 0; i < 2; ++i) seen[i] = skins[i]->pose(BoundSpan::kShutter);
  EXPECT_FALSE(seen[0].expired());
  EXPECT_EQ(skins[0]->pose(BoundSpan::kShutter), seen[0].lock());  // used again: the other one is older now
  seen[2] = skins[2]->pose(BoundSpan::kShutter);
  EXPECT_FALSE(seen[0].expired());
  EXPECT_TRUE(seen[1].expired());
  EXPECT_FALSE(seen[2].expired());
}

TEST_F(PosedCharacterSkinTest, WholePosesWithTreesAreChargedBeforeTheyAreMade) {
  const int64_t before = ledger_.current(MemoryTag::kSkins);
  const auto plain = skin(pose());
  EXPECT_EQ(ledger_.current(MemoryTag::kSkins), before);
  const auto pushed = skin(pose(0, true, true));
  const int64_t charged = ledger_.current(MemoryTag::kSkins) - before;
  EXPECT_GE(charged, static_cast<int64_t>(4 * pushed->pose(BoundSpan::kFrame)->bytes()));
  EXPECT_LT(charged, static_cast<int64_t>(5 * pushed->pose(BoundSpan::kFrame)->bytes()));
  const auto another = skin(pose(0, true, true));
  EXPECT_EQ(ledger_.current(MemoryTag::kSkins) - before, charged);
}

TEST_F(PosedCharacterSkinTest, PartsOfPosesAreTheSameAndChargedBeforeTheyAreMade) {
  const auto moving = skin(pose());
  GroomParams params;
  params.strands = 400;
  params.leaf_strands = 50;
  const auto rest = std::make_shared<LimitSurface>(topology_, cage_.positions);
  TextureLibrary textures(ledger_);
  const auto groom = Groom::create("coat", params, rest, textures, QuietJob(Workers::alone(), ledger_));
  const int64_t before = ledger_.current(MemoryTag::kSkins);
  moving->reserve_for_leaves(*groom);
  const int64_t charged = ledger_.current(MemoryTag::kSkins) - before;
  size_t largest = 0;
  for (size_t leaf = 0; leaf < groom->follicles().leaves().size(); ++leaf) {
    const std::vector<uint32_t> faces = leaf_faces(*groom, leaf);
    EXPECT_TRUE(std::is_sorted(faces.begin(), faces.end()));
    for (BoundSpan span : {BoundSpan::kShutter, BoundSpan::kFrame}) {
      const SkinPose part = moving->pose(span, faces);
      const auto whole = moving->pose(span);
      ASSERT_EQ(part.keys.size(), whole->keys.size());
      EXPECT_EQ(part.transforms, whole->transforms);
      const Strands a = groom->grow(leaf, part.skin()), b = groom->grow(leaf, whole->skin());
      for (int key = 0; key < a.motion_keys(); ++key) {
        EXPECT_TRUE(std::ranges::equal(a.points(key), b.points(key))) << leaf << " " << key;
      }
      largest = std::max(largest, part.bytes());
    }
  }
  EXPECT_GE(charged, static_cast<int64_t>(2 * largest));
  skin(pose(1))->reserve_for_leaves(*groom);
  EXPECT_EQ(ledger_.current(MemoryTag::kSkins) - before, charged);
}

TEST_F(PosedCharacterSkinTest, ManyThreadsShareOnePose) {
  const auto moving = skin(pose());
  const Workers workers(4);
  std::vector<std::shared_ptr<const SkinPose>> seen(64);
  workers.for_each(seen.size(), 1, [&](WorkRange range) {
    for (size_t i = range.begin; i < range.end; ++i) seen[i] = moving->pose(BoundSpan::kShutter);
  });
  for (const auto& pose : seen) EXPECT_EQ(pose, seen[0]);
}

}  // namespace
}  // namespace pelage
