// SPDX-License-Identifier: Apache-2.0
#include "render/frame/frame_chunks.h"

#include <utility>

#include <gtest/gtest.h>

#include "procedurals/fur.h"
#include "render/accel/embree_chunk.h"
#include "render/accel/fur_chunk.h"
#include "render/frame/frame_geometry.h"
#include "tests/procedurals/random_coats.h"
#include "tests/support/allocation_meter.h"
#include "tests/support/quiet_job.h"

namespace pelage {
namespace {

class FrameChunksTest : public testing::Test {
 protected:
  /// A coat on its skin, both seen from near.
  RenderScene scene_of(const RandomCoat& coat, uint64_t memory) {
    CameraParams camera;
    const Box3f box = coat.skin->bound(BoundSpan::kShutter);
    camera.look_at = box.center();
    camera.position = box.center() + V3f(0, 0, 2 * box.size().length());
    ImageParams image;
    image.width = image.height = 2000;
    RenderParams render;
    render.memory.bytes = memory;
    std::vector<FurPart> fur(1);
    fur[0].name = "ball.coat";
    fur[0].procedurals.push_back(std::make_unique<FurProcedural>(coat.groom, coat.skin));
    fur[0].material = 1;
    SkinPart skin;
    skin.name = "ball.skin";
    skin.skin = coat.skin;
    skin.rest = coat.rest;
    return {std::move(fur),
            {skin},
            {LambertParams{}, ConeShellParams{}},
            LightSet({}),
            Camera(camera, 1, image.width, image.height),
            image,
            render};
  }

  QuietJob job_{1};
};

TEST_F(FrameChunksTest, SmallBudgetsDivideSkins) {
  const RandomCoat coat(1, {.cage_levels = 4});
  const RenderScene scene = scene_of(coat, uint64_t(64) << 20);
  const FrameChunks chunks(scene, job_);
  const size_t leaves = chunks.leaves().size();
  EXPECT_GE(leaves, 3u);
  EXPECT_EQ(chunks.name(0), "ball.coat");
  ASSERT_GT(chunks.size(), leaves + 2);
  size_t triangles = 0;
  for (auto chunk = static_cast<uint32_t>(leaves); chunk < chunks.size(); ++chunk) {
    const ChunkContents contents = chunks.grow(chunk);
    const auto& mesh = std::get<SkinMesh>(contents.geometry);
    const ChunkCounts counts = chunks.counts(chunk);
    EXPECT_EQ(mesh.triangle_count(), counts.triangles);
    EXPECT_EQ(mesh.vertex_count(), counts.vertices);
    EXPECT_EQ(chunks.name(chunk), "ball.skin");
    triangles += counts.triangles;
  }
  EXPECT_EQ(triangles, coat.skin->tessellate({}, scene.camera.view()).triangle_count());

  const RenderScene roomy = scene_of(coat, uint64_t(16) << 30);
  EXPECT_EQ(FrameChunks(roomy, job_).size(), leaves + 1);
}

// What growing takes is reserved before: the heap is never asked for more.
TEST_F(FrameChunksTest, GrowthBytesHoldWhatIsAllocated) {
  for (uint64_t seed = 0; seed < 4; ++seed) {
    const RandomCoat coat(seed, {.push_out = seed % 2 == 1, .cage_levels = 4});
    const RenderScene scene = scene_of(coat, uint64_t(64) << 20);
    const FrameChunks chunks(scene, job_);
    for (uint32_t chunk = 0; chunk < chunks.size(); ++chunk) {
      const ChunkCounts counts = chunks.counts(chunk);
      const size_t before = live_bytes();
      reset_peak();
      const ChunkContents contents = chunks.grow(chunk);
      const size_t peak = peak_bytes() - before, kept = live_bytes() - before;
      EXPECT_LE(peak, kept + counts.growth_bytes) << chunks.name(chunk) << " " << chunk << ", seed " << seed;
    }
  }
}

// What describes chunks is charged as what it is: seen by what more of them take, because a pose that
// dividing skins leaves behind for others is charged with the skins.
TEST_F(FrameChunksTest, BytesAreThoseOfTheHeap) {
  const auto measure = [&](int leaf_strands) {
    const RandomCoat coat(2, {.strands = 20000, .leaf_strands = leaf_strands});
    const RenderScene scene = scene_of(coat, uint64_t(4) << 30);
    const size_t before = live_bytes();
    const FrameChunks chunks(scene, job_);
    return std::pair(static_cast<double>(chunks.bytes()), static_cast<double>(live_bytes() - before));
  };
  const auto [few_said, few_taken] = measure(20);
  const auto [many_said, many_taken] = measure(5);
  EXPECT_NEAR((many_said - few_said) / (many_taken - few_taken), 1.0, 0.25);
}

// Where memory allows, the growth that measures boxes is the only one.
TEST_F(FrameChunksTest, LeavesGrowOnceWhereMemoryAllows) {
  const RandomCoat coat(1, {});
  for (const bool roomy : {true, false}) {
    RenderScene scene = scene_of(coat, uint64_t(4) << 30);
    if (!roomy) {
      job_.ledger().set_limit(0);
      const FrameChunks chunks(scene, job_);
      size_t all = 0;
      for (uint32_t chunk = 0; chunk < chunks.size(); ++chunk)
        all += chunks.is_skin(chunk) ? EmbreeChunk::bytes_bound(chunks.counts(chunk))
                                     : FurChunk::bytes_bound(chunks.counts(chunk), FurChunkOptions());
      scene.render.memory.bytes = static_cast<uint64_t>(job_.ledger().budgeted()) + all;
    }
    job_.ledger().set_limit(scene.render.memory.bytes);
    FrameStatistics statistics;
    const auto geometry = FrameGeometry::make(scene, job_, statistics);
    const auto leaves = static_cast<uint32_t>(coat.groom->follicles().leaves().size());
    for (uint32_t leaf = 0; leaf < leaves; ++leaf) EXPECT_EQ(geometry->growths(leaf), roomy ? 1u : 0u);
    EXPECT_GT(statistics.growth.area.chunks, 0);
  }
}

}  // namespace
}  // namespace pelage
