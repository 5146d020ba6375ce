// SPDX-License-Identifier: Apache-2.0
#include "render/reflection/cell_keys.h"

#include <algorithm>
#include <array>
#include <set>
#include <utility>
#include <vector>

#include <gtest/gtest.h>

#include "base/hash.h"
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
    HitGeometry hit_geometry;
    hit_geometry.strand = Strands(std::move(a));
    Hit hit = key_scene::hit_on(place);
    hit.part = part_;
    return *CellKeys(scene_).of(ray_, hit, hit_geometry);
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

TEST_F(CellKeysTest, PartsOfLongStrandsAreShortAndLongerInLargerCells) {
  /// Counts the parts of a strand, by size of cells. Expects that larger parts consist of whole smaller ones.
  const auto parts = [&](float pixels) {
    const float length = pixels * 0.04f;
    StrandArrays a = one_strand({V3f(0), V3f(0, length / 2, 0), V3f(0, length, 0)}, 1e-3f).release();
    HitGeometry hit_geometry;
    hit_geometry.strand = Strands(std::move(a));
    std::array<std::set<uint64_t>, 3> cells;
    std::set<std::pair<uint64_t, uint64_t>> small_in_large;
    for (int i = 0; i < 2000; ++i) {
      const Hit hit = key_scene::hit_on((static_cast<float>(i) + 0.5f) / 2000);
      const CellPath path = *CellKeys(scene_).of(ray_, hit, hit_geometry);
      for (size_t level = 0; level < 3; ++level) cells[level].insert(path[level]);
      small_in_large.emplace(path[0], path[1]);
    }
    EXPECT_EQ(small_in_large.size(), cells[0].size());
    return std::array{cells[0].size(), cells[1].size(), cells[2].size()};
  };
  using Counts = std::array<size_t, 3>;
  part_ = 3;
  EXPECT_EQ(parts(0.3f), (Counts{4, 4, 4}));
  EXPECT_EQ(parts(4 * CellKeys::kPartPixels * 0.99f), (Counts{4, 4, 4}));
  EXPECT_EQ(parts(4 * CellKeys::kPartPixels * 1.01f), (Counts{8, 4, 4}));
  EXPECT_EQ(parts(8 * CellKeys::kPartPixels * 1.01f), (Counts{16, 8, 4}));
  EXPECT_EQ(parts(16 * CellKeys::kPartPixels * 1.01f), (Counts{32, 16, 8}));
  EXPECT_EQ(parts(25000), (Counts{128, 128, 128}));
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

/// A thin skin that leans: rays in the same octant hit it from both sides.
TEST_F(CellKeysTest, TheInsideOfASkinIsApartFromItsOutside) {
  scene_.skins.resize(1);
  HitGeometry hit_geometry;
  hit_geometry.triangle.positions = {0, 0, 0, 1, -1, 0, 1, 1, -2};  // its normal is (1, 1, 1)
  hit_geometry.triangle.normals = hit_geometry.triangle.positions;
  hit_geometry.triangle.triangles = {0, 1, 2};
  hit_geometry.triangle.faces = {0};
  hit_geometry.triangle.vertex_uv.assign(3, V2f(0));
  Hit hit;
  hit.kind = HitKind::kSkin;
  hit.distance = 1;
  hit.u = hit.v = 0.25f;
  for (const bool rest : {false, true}) {
    if (rest) scene_.skins[0].rest = shapes::surface_of(shapes::square_cage(1));
    const auto hit_along = [&](const V3f& direction) {
      ray_.direction = direction;
      return *CellKeys(scene_).of(ray_, hit, hit_geometry);
    };
    const CellPath outside = hit_along(V3f(0.1f, 0.2f, -0.9f)), inside = hit_along(V3f(0.9f, 0.2f, -0.1f));
    for (size_t level = 0; level < outside.size(); ++level) EXPECT_NE(outside[level], inside[level]);
    EXPECT_EQ(outside, hit_along(V3f(0.2f, 0.1f, -0.9f)));
  }
}

TEST_F(CellKeysTest, DiffuseSkinsHaveCellsAndGlossyOnesHaveNone) {
  scene_.skins.resize(2);
  scene_.skins[1].material = 1;
  HitGeometry hit_geometry;
  hit_geometry.triangle = sphere_mesh(1, 3);
  Hit hit;
  hit.kind = HitKind::kSkin;
  hit.distance = 1;
  hit.u = hit.v = 0.25f;
  const auto diffuse = CellKeys(scene_).of(ray_, hit, hit_geometry);
  ASSERT_TRUE(diffuse.has_value());
  hit.u = 0.26f;
  EXPECT_EQ(*CellKeys(scene_).of(ray_, hit, hit_geometry), *diffuse);
  hit.part = 1;
  EXPECT_FALSE(CellKeys(scene_).of(ray_, hit, hit_geometry).has_value());
}

CellPath cells_in(uint64_t largest) { return {mix64(largest + 1), mix64(largest + 2), largest}; }

TEST(CellRange, OneOfTheRangesHasEachCell) {
  for (const uint64_t parts : {1, 3, 8}) {
    int halved = 0;
    std::vector<int> times(1000, 0);
    double last = 0;
    for (CellRange range(CellRange::kAll / parts); !range.is_over(); range.advance()) {
      if (++halved % 3 == 2 && range.can_halve()) range.halve();
      EXPECT_GT(range.share_done(), last);
      last = range.share_done();
      for (uint64_t i = 0; i < times.size(); ++i) times[i] += range.contains(cells_in(mix64(i))) ? 1 : 0;
    }
    EXPECT_EQ(last, 1);
    EXPECT_GE(static_cast<uint64_t>(halved), parts);
    for (const int count : times) EXPECT_EQ(count, 1);
  }
}

TEST(CellRange, AllHasTheFirstAndTheLastKey) {
  const CellRange all;
  EXPECT_TRUE(all.is_all());
  EXPECT_TRUE(all.contains(cells_in(0)) && all.contains(cells_in(~uint64_t{0})));
  EXPECT_FALSE(CellRange(CellRange::kAll / 2).is_all());
  EXPECT_FALSE(CellRange(1).can_halve());
}

}  // namespace
}  // namespace pelage
