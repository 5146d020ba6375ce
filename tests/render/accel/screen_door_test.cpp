// SPDX-License-Identifier: Apache-2.0
#include "render/accel/screen_door.h"

#include <cmath>

#include <gtest/gtest.h>

#include "tests/render/accel/chunk_accel_fixture.h"
#include "tests/support/effort.h"

namespace pelage {
namespace {

constexpr float kOpacities[] = {0.1f, 0.3f, 0.4f, 0.5f, 0.9f};

TEST(ScreenDoor, EveryStrandBlocksItsOpacityOfItsWidthAndEveryPlaceItsOpacityOfTheStrands) {
  constexpr int kPlaces = 10000;
  for (const float opacity : kOpacities) {
    for (uint64_t id : {0, 1, 77}) {
      const ScreenDoor door(id, 3);
      int blocked = 0;
      double sum = 0;
      for (int i = 0; i < kPlaces; ++i) {
        const float h = (2 * static_cast<float>(i) + 1) / kPlaces - 1;
        if (!door.blocks(h, opacity)) continue;
        ++blocked;
        const float inside = door.offset_inside(h, opacity);
        ASSERT_GE(inside, -1);
        ASSERT_LE(inside, 1);
        sum += inside;
      }
      // Places at the two edges of the window may fall to either side.
      EXPECT_NEAR(blocked, opacity * kPlaces, 2);
      EXPECT_NEAR(sum / blocked, 0, 4.0 / blocked);
    }
    for (const float h : {-0.99f, -0.2f, 0.0f, 0.7f}) {
      int blocked = 0;
      for (uint64_t id = 0; id < kPlaces; ++id) blocked += ScreenDoor(id, 0).blocks(h, opacity);
      // Four standard deviations of a binomial count.
      EXPECT_NEAR(blocked, opacity * kPlaces, 4 * std::sqrt(kPlaces * opacity * (1 - opacity)));
    }
  }
  EXPECT_TRUE(ScreenDoor(5, 0).blocks(0.999f, 1));
  EXPECT_EQ(ScreenDoor(5, 0).offset_inside(0.3f, 1), 0.3f);
  EXPECT_FALSE(ScreenDoor(5, 0).blocks(0.3f, 0));
}

class ScreenDoorTest : public ChunkAccelTest {
 protected:
  static ResidentChunksOptions options_of(AccelKind kind, CurveShape shape, bool door) {
    ResidentChunksOptions options;
    options.kind = kind;
    options.chunk.shape = shape;
    options.chunk.screen_door = options.fur.screen_door = door;
    return options;
  }
};

TEST_F(ScreenDoorTest, ShadowRaysAndIndirectRaysSeeTheSameOpaqueStrands) {
  const FlushDenormals flush;
  const TestChunks chunks = random_chunks(3, scene_of_kind(1));
  const uint64_t rays = repetitions(4000);
  for (const CurveShape shape : {CurveShape::kFlat, CurveShape::kRound}) {
    for (const AccelKind kind : kAccelKinds) {
      const auto accel = make(chunks, chunks.bounds(8), options_of(kind, shape, true));
      TraceThread thread;
      uint64_t differing = 0, partly = 0, lit = 0;
      for (uint64_t i = 0; i < rays; ++i) {
        Ray ray = inner_ray(3, i);
        const float product = accel->transmittance(ray, thread);
        partly += product > 0 && product < 1;
        ray.secondary = true;
        const float light = accel->transmittance(ray, thread);
        ASSERT_TRUE(light == 0 || light == 1);
        if (product == 0 || product == 1) {
          EXPECT_EQ(light, product);
        }
        lit += light > 0;
        differing += (light == 0) != static_cast<bool>(accel->closest(ray, thread));
      }
      EXPECT_GT(partly, rays / 50);
      EXPECT_GT(lit, rays / 20);
      // Embree rounds the offset differently in the two queries.
      EXPECT_LE(differing, shape == CurveShape::kFlat && kind == AccelKind::kFur ? 0 : rays / 1000);
    }
  }
}

/// Embree's flat curves are the same strands up to the rounding of points and the straight pieces.
TEST_F(ScreenDoorTest, FurTreesAgreeWithEmbree) {
  const FlushDenormals flush;
  const TestChunks chunks = random_chunks(5, scene_of_kind(1));
  const auto fur = make(chunks, chunks.bounds(8), options_of(AccelKind::kFur, CurveShape::kFlat, true));
  const auto embree = make(chunks, chunks.bounds(8), options_of(AccelKind::kEmbree, CurveShape::kFlat, true));
  TraceThread thread;
  const uint64_t rays = repetitions(4000);
  uint64_t differing = 0;
  for (uint64_t i = 0; i < rays; ++i) {
    Ray ray = inner_ray(5, i);
    ray.secondary = true;
    differing += fur->transmittance(ray, thread) != embree->transmittance(ray, thread);
  }
  EXPECT_LT(differing, rays / 50);
}

TEST_F(ScreenDoorTest, AnyChunksAnswerAsOne) {
  // Kinds of scenes with strands that are not opaque.
  for (const int kind : {1, 2, 4}) {
    const TestChunks chunks = random_chunks(7, scene_of_kind(kind));
    secondary_ = true;
    for (const AccelKind accel : kAccelKinds) {
      ResidentChunksOptions eager = options_of(accel, CurveShape::kFlat, true), lazy = eager;
      eager.eager = true;
      eager.fur.tree.build.node_cost = 0;
      expect_same(*make(chunks, std::vector<ChunkBounds>(chunks.contents.size()), eager),
                  *make(chunks, chunks.measured_bounds(1), lazy), 1, repetitions(2000));
    }
  }
}

TEST_F(ScreenDoorTest, OpaqueStrandsAndCameraRaysAreUntouched) {
  for (const int kind : {0, 1, 2}) {
    const TestChunks chunks = random_chunks(9, scene_of_kind(kind));
    // Scene 0 is opaque.
    for (const bool secondary : {false, true}) {
      if (kind > 0 && secondary) continue;
      secondary_ = secondary;
      for (const AccelKind accel : kAccelKinds) {
        expect_same(*make(chunks, chunks.bounds(8), options_of(accel, CurveShape::kFlat, false)),
                    *make(chunks, chunks.bounds(8), options_of(accel, CurveShape::kFlat, true)), 3,
                    repetitions(1500));
      }
    }
  }
}

TEST_F(ScreenDoorTest, WithoutTheDoorSecondaryRaysSeeWhatCameraRaysSee) {
  const TestChunks chunks = random_chunks(11, scene_of_kind(1));
  for (const AccelKind accel : kAccelKinds) {
    const auto one = make(chunks, chunks.bounds(8), options_of(accel, CurveShape::kFlat, false));
    const FlushDenormals flush;
    TraceThread thread;
    for (uint64_t i = 0; i < 2000; ++i) {
      Ray ray = random_ray(5, i), secondary = ray;
      secondary.secondary = true;
      ASSERT_EQ(one->transmittance(ray, thread), one->transmittance(secondary, thread));
      const Hit a = one->closest(ray, thread), b = one->closest(secondary, thread);
      ASSERT_EQ(a.distance, b.distance);
      ASSERT_EQ(a.strand_id, b.strand_id);
      ASSERT_EQ(a.v, b.v);
    }
  }
}

}  // namespace
}  // namespace pelage
