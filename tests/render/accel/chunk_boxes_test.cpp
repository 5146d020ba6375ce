// SPDX-License-Identifier: Apache-2.0
#include "render/accel/chunk_boxes.h"

#include <gtest/gtest.h>

#include "geom/curve_bounds.h"
#include "tests/render/accel/chunk_accel_fixture.h"

namespace pelage {
namespace {

/// Around all that a chunk holds at any time of the shutter.
Box3f box_of_contents(const ResidentChunks& chunks, uint32_t chunk) {
  return chunks.visit(chunk, 0, [](const ChunkGeometry& geometry) {
    Box3f box;
    Strands strand;
    for (uint32_t index = 0; index < geometry.strand_count(); ++index) {
      geometry.strand(index, strand);
      box.extendBy(exact_bounds(strand));
    }
    return box;
  });
}

Box3f enlarged(const Box3f& box, float by) { return {box.min - V3f(by), box.max + V3f(by)}; }

/// Of every kind of strand.
class ChunkBoxesScenes : public ChunkAccelTest, public testing::WithParamInterface<int> {};

TEST_P(ChunkBoxesScenes, HoldTheStrandsThatRaysMeet) {
  const TestChunks chunks = random_chunks(7, scene_of_kind(GetParam()));
  for (const AccelKind kind : kAccelKinds) {
    for (const bool eager : {false, true}) {
      ResidentChunksOptions options;
      options.kind = kind;
      options.eager = eager;
      // Boxes that cover the whole shutter, and boxes that are linear in time.
      for (const int keys : {1, 2}) {
        const auto held = hold(chunks, chunks.measured_bounds(keys), options);
        Box3f all;
        for (uint32_t chunk = 0; chunk < held->size(); ++chunk) {
          EXPECT_EQ(held->part(chunk), chunks.contents[chunk].part);
          const Box3f& whole = held->boxes().whole(chunk);
          all.extendBy(whole);
          if (held->is_skin(chunk)) {
            EXPECT_TRUE(whole.intersects(V3f(0, 0, chunks.contents[chunk].part == 0 ? 0.9f : -0.2f)));
            continue;
          }
          const Box3f box = box_of_contents(*held, chunk);
          const Box3f outer = enlarged(whole, 2e-6f);
          ASSERT_FALSE(box.isEmpty());
          EXPECT_TRUE(outer.intersects(box.min) && outer.intersects(box.max)) << chunk;
          // What snapping may add is less than the width of a strand; where the strands move in pieces, so do
          // their boxes between open and close.
          const float spare = GetParam() == 3 || GetParam() == 6 ? 0.4f : 0.03f;
          const Box3f inner = enlarged(box, spare);
          EXPECT_TRUE(inner.intersects(whole.min) && inner.intersects(whole.max)) << chunk;
        }
        EXPECT_EQ(held->boxes().tree()->bounds(), all);
      }
    }
  }
}

INSTANTIATE_TEST_SUITE_P(All, ChunkBoxesScenes, testing::Range(0, kSceneKinds));

// They are there before anything is grown, and stay when everything was.
TEST_F(ChunkAccelTest, BoxesStayAsTheyAre) {
  const TestChunks chunks = random_chunks(5, {});
  const auto held = hold(chunks, chunks.measured_bounds(1));
  std::vector<Box3f> before;
  for (uint32_t chunk = 0; chunk < held->size(); ++chunk) before.push_back(held->boxes().whole(chunk));
  EXPECT_EQ(held->counts().expansions, 0);
  for (uint32_t chunk = 0; chunk < held->size(); ++chunk) {
    box_of_contents(*held, chunk);
    EXPECT_EQ(held->boxes().whole(chunk), before[chunk]);
  }
  EXPECT_EQ(held->counts().expansions, static_cast<int64_t>(held->size()));
}

}  // namespace
}  // namespace pelage
