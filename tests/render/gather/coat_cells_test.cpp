// SPDX-License-Identifier: Apache-2.0
#include "render/gather/coat_cells.h"

#include <algorithm>
#include <set>

#include <gtest/gtest.h>

#include "base/hash.h"
#include "tests/groom/shapes.h"
#include "tests/render/gather/key_scene.h"

namespace pelage {
namespace {

using key_scene::hit_on;

/// A strand at `at` in space that grows at (u, v) of the square [0, 1]^2 at rest. 0.04 units are a pixel.
Strands grown(const V3f& at, const RootAddress& root, float length = 0.01f) {
  StrandArrays a = one_strand({at, at + V3f(0, length / 2, 0), at + V3f(0, length, 0)}, 1e-4f).release();
  a.roots = {root};
  a.root_uv = {V2f(0)};
  return Strands(std::move(a));
}

class CoatCellsTest : public ::testing::Test {
 protected:
  CoatCellsTest() {
    for (int part = 0; part < 2; ++part) {
      fur_.emplace_back();
      fur_.back().rest = shapes::surface_of(shapes::square_cage(1));
    }
  }
  /// The cells that a hit is assigned to for many random numbers.
  std::set<uint64_t> cells(const Strands& strand, float place = 0.5f, uint32_t part = 0) const {
    const CoatCells cells(camera_, fur_, 64);
    Hit hit = hit_on(place);
    hit.part = part;
    std::set<uint64_t> result;
    for (uint64_t i = 0; i < 500; ++i) result.insert(cells.key(hit, strand, length_, place, mix64(i)));
    return result;
  }
  /// The patches of many strands that grow at the same place.
  std::set<uint64_t> patches(const RootAddress& root, uint32_t part = 0) const {
    const CoatCells cells(camera_, fur_, 64);
    Hit hit = hit_on(0.5f);
    hit.part = part;
    std::set<uint64_t> result;
    for (hit.strand_id = 0; hit.strand_id < 500; ++hit.strand_id)
      result.insert(cells.patch(hit, grown(V3f(0), root)));
    return result;
  }
  static bool share(const std::set<uint64_t>& a, const std::set<uint64_t>& b) {
    return std::any_of(a.begin(), a.end(), [&](uint64_t key) { return b.contains(key); });
  }

  const Camera camera_ = key_scene::camera();
  std::vector<FurPart> fur_;
  float length_ = 0.25f;  // pixels
};

TEST_F(CoatCellsTest, NeighboursOnTheSkinShareLightWhereverTheyAreInSpace) {
  const auto cell = cells(grown(V3f(0), {0, 0.5f, 0.5f}));
  EXPECT_TRUE(share(cell, cells(grown(V3f(0), {0, 0.51f, 0.51f}))));
  EXPECT_TRUE(share(cell, cells(grown(V3f(1, 0.3f, 0), {0, 0.51f, 0.51f})))) << "far apart when posed";
  // Two cells side by side reach over 2 * 2 pixels = 0.16 units at most.
  EXPECT_FALSE(share(cell, cells(grown(V3f(0), {0, 0.67f, 0.5f})))) << "as two ears that touch";
  EXPECT_FALSE(share(cell, cells(grown(V3f(0), {0, 0.5f, 0.33f}))));
}

TEST_F(CoatCellsTest, CoatsAndTheTwoSidesOfASkinAreApart) {
  const Strands strand = grown(V3f(0), {0, 0.5f, 0.5f});
  const auto cell = cells(strand);
  EXPECT_FALSE(share(cell, cells(strand, 0.5f, 1)));
  ControlMesh back = shapes::square_cage(1);
  std::reverse(back.face_vertices.begin(), back.face_vertices.end());
  back.face_uv.clear();
  back.uv.clear();
  fur_[0].rest = shapes::surface_of(back);
  EXPECT_FALSE(share(cell, cells(strand)));
}

TEST_F(CoatCellsTest, PatchesAreEightPixelsLargeAndOverlap) {
  const auto patch = patches({0, 0.5f, 0.5f});
  EXPECT_GT(patch.size(), 1u) << "a random number decides";
  EXPECT_TRUE(share(patch, patches({0, 0.55f, 0.5f})));
  // Two patches side by side reach over 2 * 8 pixels = 0.64 units at most, and over 0.32 at least.
  EXPECT_TRUE(share(patch, patches({0, 0.6f, 0.5f})));
  EXPECT_FALSE(share(patches({0, 0.1f, 0.5f}), patches({0, 0.9f, 0.5f})));
  EXPECT_FALSE(share(patch, patches({0, 0.5f, 0.5f}, 1))) << "of another coat";
}

TEST_F(CoatCellsTest, CellsDivideLongStrands) {
  const Strands strand = grown(V3f(0), {0, 0.5f, 0.5f});
  EXPECT_TRUE(share(cells(strand, 0.1f), cells(strand, 0.9f)));
  length_ = 50;
  EXPECT_FALSE(share(cells(strand, 0.1f), cells(strand, 0.9f)));
  EXPECT_FALSE(share(cells(strand, 0.5f), cells(strand, 0.6f))) << "5 pixels apart";
  EXPECT_TRUE(share(cells(strand, 0.5f), cells(strand, 0.51f)));
}

TEST_F(CoatCellsTest, ScaleOfTheCharacterCounts) {
  const Strands a = grown(V3f(0), {0, 0.5f, 0.5f}), b = grown(V3f(0), {0, 0.54f, 0.5f});
  EXPECT_TRUE(share(cells(a), cells(b))) << "a pixel apart";
  fur_[0].scale = 100;
  EXPECT_FALSE(share(cells(a), cells(b))) << "100 pixels apart";
}

TEST_F(CoatCellsTest, StrandsWithoutASkinUseTheirRoots) {
  const auto free = [](float x) { return one_strand({{x, 0, 0}, {x, 0.01f, 0}}, 1e-4f); };
  EXPECT_TRUE(share(cells(free(0.5f)), cells(free(0.52f))));
  EXPECT_FALSE(share(cells(free(0.5f)), cells(free(0.67f))));
}

TEST(GatherPointKeys, OnlyThinStrandsUseCells) {
  const RenderScene scene = key_scene::make({});
  const auto same_key = [&](float radius, uint32_t samples) {
    const GatherPointKeys keys(scene, samples);
    HitGeometry hit_geometry;
    hit_geometry.strand = one_strand({{0, 0, 0}, {0.05f, 0, 0}, {0.1f, 0, 0}}, radius);  // 2.5 pixels long
    Hit a = hit_on(0.5f), b = a;
    b.strand_id = a.strand_id + 1;
    int same = 0;
    for (uint64_t i = 0; i < 200; ++i) {
      const V2f random(unit_float(hash64(i, 1)), unit_float(hash64(i, 2)));
      same += key_scene::key_of(keys, a, hit_geometry, random).gather_point ==
                      key_scene::key_of(keys, b, hit_geometry, random).gather_point
                  ? 1
                  : 0;
    }
    return same;
  };
  EXPECT_EQ(same_key(1e-4f, 64), 200) << "0.005 pixels wide: 0.8 samples";
  EXPECT_EQ(same_key(1e-2f, 64), 0) << "0.5 pixels wide: 80 samples";
  EXPECT_EQ(same_key(1e-2f, 2), 200) << "2.5 samples";
  GatherParams apart;
  apart.cells = false;
  const RenderScene without = key_scene::make(apart);
  const GatherPointKeys keys(without, 1);
  HitGeometry hit_geometry;
  hit_geometry.strand = one_strand({{0, 0, 0}, {0.1f, 0, 0}}, 1e-4f);
  Hit a = hit_on(0.5f), b = a;
  b.strand_id = a.strand_id + 1;
  EXPECT_NE(key_scene::key_of(keys, a, hit_geometry, {0, 0}).gather_point,
            key_scene::key_of(keys, b, hit_geometry, {0, 0}).gather_point);
}

}  // namespace
}  // namespace pelage
