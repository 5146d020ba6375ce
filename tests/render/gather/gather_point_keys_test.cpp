// SPDX-License-Identifier: Apache-2.0
#include "render/gather/gather_point_keys.h"

#include <map>
#include <set>

#include <gtest/gtest.h>

#include "base/hash.h"
#include "tests/render/gather/key_scene.h"

namespace pelage {
namespace {

using key_scene::hit_on;
using key_scene::key_of;

/// Samples per pixel: so many that strands are not too thin for gather points.
constexpr uint32_t kSamples = 64;

/// A straight strand of `length` across the view.
HitGeometry strand(float length) {
  HitGeometry hit_geometry;
  hit_geometry.strand = one_strand({{0, 0, 0}, {length / 2, 0, 0}, {length, 0, 0}}, 0.01f);
  return hit_geometry;
}

/// Gather points that a strand has within the given part of its length, and how often each is chosen.
std::map<uint64_t, int> gather_points(const GatherPointKeys& keys, const HitGeometry& hit_geometry,
                                      float from, float to) {
  std::map<uint64_t, int> result;
  for (uint64_t i = 0; i < 4000; ++i) {
    const float place = from + (to - from) * unit_float(hash64(i, 1));
    ++result[key_of(keys, hit_on(place), hit_geometry, {unit_float(hash64(i, 2)), 0}).gather_point];
  }
  return result;
}

TEST(GatherPointKeys, AreAsFarApartAsTheSpacingAtMost) {
  RenderScene scene = key_scene::make({});
  const GatherPointKeys keys(scene, kSamples);
  // 2 units are 50 pixels: 16 parts of 3.1 pixels.
  EXPECT_EQ(gather_points(keys, strand(2), 0, 1).size(), 17u);
  EXPECT_EQ(gather_points(keys, strand(0.5f), 0, 1).size(), 5u) << "12.5 pixels";
  EXPECT_EQ(gather_points(keys, strand(0.05f), 0, 1).size(), 2u) << "shorter than the spacing";
  scene.render.gather.spacing = 8;
  EXPECT_EQ(gather_points(keys, strand(2), 0, 1).size(), 9u);
}

TEST(GatherPointKeys, InterpolateLinearlyOnAverage) {
  const RenderScene scene = key_scene::make({});
  const GatherPointKeys keys(scene, kSamples);
  const HitGeometry hit_geometry = strand(0.5f);  // gather points at 0, 1/4, 1/2, 3/4, 1
  const auto around = gather_points(keys, hit_geometry, 0.299f, 0.301f);
  ASSERT_EQ(around.size(), 2u);
  const uint64_t before = key_of(keys, hit_on(0.25f), hit_geometry, {0, 0}).gather_point;
  EXPECT_NEAR(around.at(before) / 4000.0, 0.8, 0.03) << "a fifth of the way";
}

TEST(GatherPointKeys, APatchIsAnEighthOfAStrandOrTwoGatherPoints) {
  const RenderScene scene = key_scene::make({});
  const GatherPointKeys keys(scene, kSamples);
  const auto patches = [&](float length) {
    const HitGeometry hit_geometry = strand(length);
    std::set<uint64_t> result;
    for (uint32_t i = 0; i <= 4000; ++i)
      result.insert(key_of(keys, hit_on(static_cast<float>(i) / 4000), hit_geometry, {0.5f, 0}).patch);
    return result.size();
  };
  EXPECT_EQ(patches(2), 8u) << "16 gather points";
  EXPECT_EQ(patches(4), 17u) << "32 parts of 3.1 pixels";
  EXPECT_LE(patches(0.05f), 2u);
}

TEST(RecentGatherPoints, KeepsTheGatherPointsOfEachStrand) {
  RecentGatherPoints recent;
  int made = 0;
  const auto level = [&](uint32_t part, uint64_t id) {
    const auto make = [&] {
      ++made;
      return StrandGatherPoints{1, static_cast<int>(part * 10000 + id), false, 0};
    };
    return recent.of({part, id}, make).level;
  };
  for (uint32_t part = 0; part < 2; ++part) {
    for (uint64_t id = 0; id < 5000; ++id) {
      ASSERT_EQ(level(part, id), static_cast<int>(part * 10000 + id));
      ASSERT_EQ(level(part, id), static_cast<int>(part * 10000 + id)) << "again";
    }
  }
  EXPECT_EQ(made, 10000) << "each only once in a row";
}

TEST(GatherPointKeys, TellStrandsAndCoatsApartAndIgnoreChunks) {
  const RenderScene scene = key_scene::make({});
  const GatherPointKeys keys(scene, kSamples);
  const HitGeometry hit_geometry = strand(2);
  const Hit hit = hit_on(0.4f);
  const GatherPointKey key = key_of(keys, hit, hit_geometry, {0.3f, 0});
  Hit elsewhere = hit;
  elsewhere.start = {12, 34, 2, 0.8f};
  elsewhere.strand_index = 99;
  elsewhere.distance = 5;
  EXPECT_EQ(key_of(keys, elsewhere, hit_geometry, {0.3f, 0}).gather_point, key.gather_point);
  Hit other = hit;
  other.strand_id = 8;
  EXPECT_NE(key_of(keys, other, hit_geometry, {0.3f, 0}).gather_point, key.gather_point);
  EXPECT_EQ(key_of(keys, other, hit_geometry, {0.3f, 0}).coat, key.coat);
  EXPECT_EQ(key_of(keys, other, hit_geometry, {0.3f, 0}).zone, key.zone);
  other = hit;
  other.part = 4;
  EXPECT_NE(key_of(keys, other, hit_geometry, {0.3f, 0}).gather_point, key.gather_point);
  EXPECT_NE(key_of(keys, other, hit_geometry, {0.3f, 0}).coat, key.coat);
}

/// A triangle of a face whose unit square is 2 x 1 units of space.
HitGeometry skin_triangle() {
  HitGeometry hit_geometry;
  hit_geometry.triangle.positions = {0, 0, 0, 1, 0, 0, 0, 0.5f, 0};
  hit_geometry.triangle.normals = {0, 0, 1, 0, 0, 1, 0, 0, 1};
  hit_geometry.triangle.triangles = {0, 1, 2};
  hit_geometry.triangle.vertex_uv = {V2f(0, 0), V2f(0.5f, 0), V2f(0, 0.5f)};
  hit_geometry.triangle.faces = {5};
  return hit_geometry;
}

TEST(GatherPointKeys, AFaceOfASkinHasAGridOfGatherPoints) {
  const RenderScene scene = key_scene::make({});
  const GatherPointKeys keys(scene, kSamples);
  const HitGeometry hit_geometry = skin_triangle();
  std::map<uint64_t, int> found;
  Hit hit;
  hit.kind = HitKind::kSkin;
  for (uint64_t i = 0; i < 20000; ++i) {
    hit.u = unit_float(hash64(i, 1));
    hit.v = (1 - hit.u) * unit_float(hash64(i, 2));
    ++found[key_of(keys, hit, hit_geometry, {unit_float(hash64(i, 3)), unit_float(hash64(i, 4))})
                .gather_point];
  }
  // The face is 50 x 25 pixels: 32 x 16 parts of at most 2 pixels. Half of its u and v, below the diagonal:
  // 17 x 9 gather points, of which about half are near the triangle.
  EXPECT_GT(found.size(), 70u);
  EXPECT_LT(found.size(), 110u);
}

TEST(GatherPointKeys, AFaceThatReachesBehindTheCameraHasGatherPointsWhereItIsSeen) {
  const RenderScene scene = key_scene::make({});
  const GatherPointKeys keys(scene, kSamples);
  HitGeometry floor = skin_triangle();
  floor.triangle.positions = {-400, -1, 400, 1200, -1, 400, -400, -1, -1200};
  std::set<uint64_t> found;
  Hit hit;
  hit.kind = HitKind::kSkin;
  for (uint64_t i = 0; i < 500; ++i) {
    hit.u = 0.25f + 0.00025f * unit_float(hash64(i, 1));  // from x = 0 to 0.4, about 10 pixels
    hit.v = 0.25f;
    found.insert(key_of(keys, hit, floor, {unit_float(hash64(i, 2)), 0}).gather_point);
  }
  EXPECT_GE(found.size(), 5u);
  EXPECT_LE(found.size(), 14u);
}

}  // namespace
}  // namespace pelage
