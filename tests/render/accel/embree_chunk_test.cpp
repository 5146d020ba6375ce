// SPDX-License-Identifier: Apache-2.0
#include "render/accel/embree_chunk.h"

#include <gtest/gtest.h>

#include "render/accel/flush_denormals.h"
#include "render/accel/fur_chunk.h"
#include "tests/render/accel/chunk_scenes.h"

namespace pelage {
namespace {

SkinMesh bumpy_grid(uint32_t side, int keys) {
  SkinMesh mesh;
  mesh.motion_keys = keys;
  for (int key = 0; key < keys; ++key) {
    for (uint32_t i = 0; i < side * side; ++i) {
      const float z = 0.2f * unit_float(hash64(i, key));
      mesh.positions.insert(mesh.positions.end(),
                            {static_cast<float>(i % side), static_cast<float>(i / side), z});
      mesh.normals.insert(mesh.normals.end(), {0, 0, 1});
    }
  }
  for (uint32_t y = 0; y + 1 < side; ++y) {
    for (uint32_t x = 0; x + 1 < side; ++x) {
      const uint32_t a = y * side + x;
      mesh.triangles.insert(mesh.triangles.end(), {a, a + 1, a + side, a + 1, a + side + 1, a + side});
    }
  }
  mesh.faces.assign(mesh.triangle_count(), 0);
  mesh.vertex_uv.assign(mesh.triangles.size(), V2f(0));
  return mesh;
}

class EmbreeChunkTest : public testing::Test {
 protected:
  /// That what is reserved covers what is held at any moment; and not by far more than is needed.
  void expect_bounded(TestChunks chunks, CurveShape shape, size_t expected_slack) {
    const ChunkCounts counts = chunks.counts(0);
    ChunkContents contents = chunks.grow(0);
    EmbreeChunkOptions options;
    options.shape = shape;
    const EmbreeChunk chunk(std::move(contents), 0, 0, options, device_, patterns_);
    const size_t bound = EmbreeChunk::bytes_bound(counts);
    const size_t while_built = chunk.build_peak_bytes();
    EXPECT_LE(chunk.bytes(), bound);
    EXPECT_LE(while_built, bound);
    EXPECT_LE(EmbreeChunk::bytes_bound(counts, while_built), bound);
    EXPECT_LE(bound, expected_slack * while_built + 32 * 1024);
  }

  MemoryLedger ledger_;
  EmbreeDevice device_;
  SegmentPatterns patterns_{ledger_};
};

TEST_F(EmbreeChunkTest, ReservationsHoldForStrandsOfEveryKindAndSize) {
  for (CurveBasis basis :
       {CurveBasis::kPinnedBSpline, CurveBasis::kCatmullRom, CurveBasis::kLinear, CurveBasis::kBSpline}) {
    for (CurveShape shape : {CurveShape::kFlat, CurveShape::kRound}) {
      for (int keys = 1; keys <= 4; ++keys) {
        for (size_t strands : {1, 2, 3, 5, 9, 20, 60, 200, 500, 1171}) {
          SCOPED_TRACE(testing::Message() << static_cast<int>(basis) << " " << static_cast<int>(shape) << " "
                                          << keys << " " << strands);
          RandomStrandOptions o;
          o.basis = basis;
          o.motion_keys = keys;
          o.strands = strands;
          o.min_points = strands % 2 == 0 ? 4 : 8;
          o.max_points = 8;
          o.motion = strands % 3 == 0 ? 0.5f : 0.01f;
          o.wander = strands % 5 == 0 ? 1.0f : 0.1f;
          TestChunks chunks;
          chunks.add_fur(random_strands(strands, o), 0);
          expect_bounded(std::move(chunks), shape, keys == 1 ? 4 : 5);
        }
      }
    }
  }
}

TEST_F(EmbreeChunkTest, ReservationsHoldForLargeChunksAndSkins) {
  for (size_t strands : {4000, 8000}) {
    for (int keys : {1, 2}) {
      RandomStrandOptions o;
      o.motion_keys = keys;
      o.strands = strands;
      o.min_points = o.max_points = 8;
      TestChunks chunks;
      chunks.add_fur(random_strands(strands, o), 0);
      expect_bounded(std::move(chunks), CurveShape::kFlat, 3);
    }
  }
  for (int keys = 1; keys <= 4; ++keys) {
    for (uint32_t side : {2, 3, 7, 30, 110}) {
      TestChunks chunks;
      chunks.add_skin(bumpy_grid(side, keys), 0);
      expect_bounded(std::move(chunks), CurveShape::kFlat, 6);
    }
  }
}

TEST_F(EmbreeChunkTest, HoldsFewBytesPerStrand) {
  RandomStrandOptions o;
  o.strands = 2000;
  o.min_points = o.max_points = 8;
  o.radius = 0.002f;
  TestChunks chunks;
  chunks.add_fur(random_strands(5, o), 0);
  const EmbreeChunk chunk(chunks.grow(0), 0, 0, {}, device_, patterns_);
  EXPECT_LT(chunk.bytes(), 480 * o.strands);
}

// What the fur tree does near the start of a ray, chunks of Embree's curves do, too.
TEST_F(EmbreeChunkTest, MeetsNearStrandsButTheOneThatARayStartsOn) {
  StrandArrays straight;  // along x, of radius 0.25
  straight.basis = CurveBasis::kPinnedBSpline;
  for (int i = 0; i < 8; ++i)
    straight.points.insert(straight.points.end(), {static_cast<float>(i), 0, 0, 0.25f});
  straight.first_point = {0, 8};
  straight.ids = {3};
  TestChunks chunks;
  chunks.add_fur(Strands(std::move(straight)), 0);
  chunks.widest = 0.5f;
  constexpr uint32_t kNumber = 5, kInFurTree = 6;
  const FurGrid grid(0.5f);
  const EmbreeChunk embree(chunks.grow(0), kNumber, chunks.widest, {}, device_, patterns_);
  const FurChunk fur(chunks.grow(0), kNumber, grid, {});
  const FlushDenormals flush;
  const auto expect_met = [&](const Ray& ray, bool met) {
    for (const ChunkGeometry* chunk :
         {static_cast<const ChunkGeometry*>(&embree), static_cast<const ChunkGeometry*>(&fur)}) {
      FurRays rays;
      NearestSoFar nearest;
      HitGeometry geometry;
      Crossings crossings;
      EXPECT_EQ(chunk->closest(ray, rays, nearest, geometry), met);
      EXPECT_EQ(chunk->collect(ray, rays, crossings), !met);
      if (!met) continue;
      EXPECT_NEAR(nearest.hit.distance, -ray.origin.z, 1e-3f);
      EXPECT_EQ(nearest.hit.start.chunk, kNumber);
      EXPECT_NEAR(nearest.hit.start.place, 3.5f, 1e-3f);
    }
  };
  Ray ray;
  ray.origin = V3f(3.5f, 0.1f, -0.2f);
  ray.direction = V3f(0, 0, 1);
  expect_met(ray, true);  // of another strand, within a width
  ray.start = {kNumber, 0, 7, 3.5f};
  expect_met(ray, false);
  ray.start.place = 6;  // 2.5 units along the strand: more than two widths
  expect_met(ray, true);
  ray.start.place = 3.5f;
  ray.origin.z = -1.1f;  // farther than two widths along the ray
  expect_met(ray, true);
  ray.start.chunk = kInFurTree;
  ray.origin.z = -0.2f;
  expect_met(ray, true);
  ray.near = 0.3f;
  expect_met(ray, false);
}

TEST_F(EmbreeChunkTest, GivesEverythingBackToEmbree) {
  RandomStrandOptions o;
  o.strands = 300;
  TestChunks chunks;
  chunks.add_fur(random_strands(5, o), 0);
  auto chunk =
      std::make_unique<EmbreeChunk>(chunks.grow(0), 0, 0.0f, EmbreeChunkOptions{}, device_, patterns_);
  const size_t bytes =
      chunk->bytes() - sizeof(EmbreeChunk) + sizeof(PackedStrands) - chunk->strands()->bytes();
  EmbreeMeter after;
  chunk.reset();
  EXPECT_EQ(after.held(), -static_cast<int64_t>(bytes));
}

}  // namespace
}  // namespace pelage
