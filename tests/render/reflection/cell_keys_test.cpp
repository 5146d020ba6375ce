// SPDX-License-Identifier: Apache-2.0
#include "render/reflection/cell_keys.h"

#include <algorithm>
#include <set>

#include <gtest/gtest.h>

#include "tests/groom/shapes.h"
#include "tests/render/gather/key_scene.h"

namespace pelage {
namespace {

/// Strands on the square [0, 1]^2 at rest, seen from far enough that 0.04 units are a pixel.
class CellKeysTest : public ::testing::Test {
 protected:
  CellKeysTest() {
    for (FurPart& part : scene_.fur) part.rest = shapes::surface_of(shapes::square_cage(1));
    scene_.materials = {LambertParams{}, GlossyParams{}};
    ray_.direction = V3f(0.5f, 0.5f, -0.7f);
  }
  CellPath cells(const RootAddress& root, float place = 0.1f, const V3f& at = V3f(0)) const {
    StrandArrays a = one_strand({at, at + V3f(0, 0.2f, 0), at + V3f(0, 0.4f, 0)}, 1e-3f).release();
    a.roots = {root};
    a.root_uv = {V2f(0)};
    HitGeometry met;
    met.strand = Strands(std::move(a));
    Hit hit = key_scene::hit_on(place);
    hit.part = part_;
    return *CellKeys(scene_).of(ray_, hit, met);
  }

  RenderScene scene_ = key_scene::make({});
  Ray ray_;
  uint32_t part_ = 0;
};

TEST_F(CellKeysTest, NeighboursOnTheSkinShareACellWhereverTheyAreInSpace) {
  const CellPath cell = cells({0, 0.40f, 0.40f});
  EXPECT_EQ(cell, cells({0, 0.41f, 0.41f}));
  EXPECT_EQ(cell, cells({0, 0.41f, 0.41f}, 0.1f, V3f(0.5f, -0.5f, 0))) << "far apart when posed";
  const CellPath far = cells({0, 0.9f, 0.9f});
  EXPECT_LT(CellKeys::kPixels * 0.04f, 0.5f)
      << "the largest side of a smallest cell is less than the distance";
  EXPECT_NE(cell[0], far[0]);
}

TEST_F(CellKeysTest, SmallCellsLieInsideLargeOnes) {
  std::set<std::pair<uint64_t, uint64_t>> pairs;
  std::set<uint64_t> small, large;
  for (int i = 0; i < 4000; ++i) {
    const CellPath cell = cells({0, static_cast<float>(i % 64) / 64, static_cast<float>(i / 64) / 64});
    pairs.emplace(cell[0], cell[1]);
    small.insert(cell[0]);
    large.insert(cell[1]);
  }
  EXPECT_EQ(pairs.size(), small.size()) << "each small cell has one large cell";
  EXPECT_LT(large.size(), small.size());
  // Cells are more than half of kPixels large, here 4 to 8 pixels of 0.04 units.
  EXPECT_GE(small.size(), 9u);
  EXPECT_LE(small.size(), 49u);
}

TEST_F(CellKeysTest, TheLargestCellsAreEightTimesAsLargeAsTheSmallest) {
  // The smallest cells are 0.25 units large here.
  const CellPath near = cells({0, 0.1f, 0.1f}), far = cells({0, 1.0f, 0.1f});
  EXPECT_EQ(cells({0, 0.4f, 0.1f})[1], near[1]) << "0.5 units large";
  EXPECT_NE(far[1], near[1]);
  EXPECT_EQ(far[2], near[2]) << "2 units large";
}

TEST_F(CellKeysTest, DividesCoatsPartsOfStrandsAndDirections) {
  const RootAddress root{0, 0.4f, 0.4f};
  std::set<CellPath> apart{cells(root)};
  EXPECT_EQ(cells(root, 0.12f), cells(root));
  for (const float place : {0.3f, 0.6f, 1.0f}) apart.insert(cells(root, place));
  part_ = 1;
  apart.insert(cells(root));
  part_ = 0;
  ray_.direction = V3f(0.6f, 0.4f, -0.7f);
  EXPECT_TRUE(apart.contains(cells(root)));
  for (int axis = 0; axis < 3; ++axis) {
    ray_.direction[axis] *= -1;
    apart.insert(cells(root));
  }
  EXPECT_EQ(apart.size(), 8u);
}

TEST_F(CellKeysTest, PartsOfLongStrandsAreShort) {
  const auto parts = [&](float length) {
    StrandArrays a = one_strand({V3f(0), V3f(0, length / 2, 0), V3f(0, length, 0)}, 1e-3f).release();
    HitGeometry met;
    met.strand = Strands(std::move(a));
    std::set<CellPath> cells;
    for (int i = 0; i < 2000; ++i)
      cells.insert(*CellKeys(scene_).of(ray_, key_scene::hit_on((static_cast<float>(i) + 0.5f) / 2000), met));
    return cells.size();
  };
  part_ = 3;
  EXPECT_EQ(parts(0.01f), 4u);
  EXPECT_EQ(parts(4 * 0.04f * CellKeys::kPartPixels * 0.99f), 4u);
  EXPECT_EQ(parts(4 * 0.04f * CellKeys::kPartPixels * 1.01f), 8u);
  EXPECT_EQ(parts(1000), 128u);
}

TEST_F(CellKeysTest, TheTwoSidesOfASkinAreApart) {
  const CellPath cell = cells({0, 0.4f, 0.4f});
  ControlMesh back = shapes::square_cage(1);
  std::reverse(back.face_vertices.begin(), back.face_vertices.end());
  back.face_uv.clear();
  back.uv.clear();
  scene_.fur[0].rest = shapes::surface_of(back);
  EXPECT_NE(cells({0, 0.4f, 0.4f})[0], cell[0]);
}

TEST_F(CellKeysTest, DiffuseSkinsHaveCellsAndGlossyOnesHaveNone) {
  scene_.skins.resize(2);
  scene_.skins[1].material = 1;
  HitGeometry met;
  met.triangle = sphere_mesh(1, 3);
  Hit hit;
  hit.kind = HitKind::kSkin;
  hit.distance = 1;
  hit.u = hit.v = 0.25f;
  const auto diffuse = CellKeys(scene_).of(ray_, hit, met);
  ASSERT_TRUE(diffuse.has_value());
  hit.u = 0.26f;
  EXPECT_EQ(*CellKeys(scene_).of(ray_, hit, met), *diffuse);
  hit.part = 1;
  EXPECT_FALSE(CellKeys(scene_).of(ray_, hit, met).has_value());
}

}  // namespace
}  // namespace pelage
