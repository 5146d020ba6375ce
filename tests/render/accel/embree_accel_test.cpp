// SPDX-License-Identifier: Apache-2.0
#include "tests/render/accel/embree_accel.h"

#include <cmath>
#include <limits>

#include <gtest/gtest.h>

#include "base/parallel.h"
#include "render/accel/flush_denormals.h"
#include "tests/geom/random_strands.h"
#include "tests/render/accel/accel_scenes.h"

namespace pelage {
namespace {

class EmbreeAccelTest : public testing::Test {
 protected:
  EmbreeAccel make(std::vector<AccelStrands> strands, std::vector<const SkinMesh*> skins = {},
                   const EmbreeOptions& options = {}) {
    return EmbreeAccel(std::move(strands), std::move(skins), options, workers_);
  }

  TraceThread thread_;
  Workers workers_{2};
  FlushDenormals flush_;
};

TEST_F(EmbreeAccelTest, StrandsTaperToTheirEnds) {
  // The phantom point beyond a tapering tip has a negative radius; the last segment must still be there.
  StrandArrays a;
  a.points = {0, 0, 0, 0.1f, 1, 0, 0, 0.05f, 2, 0, 0, 0.001f};
  a.first_point = {0, 3};
  a.ids = {0};
  const Strands strands(std::move(a));
  const EmbreeAccel accel = make({{&strands, 0, {}}});
  EXPECT_TRUE(accel.closest(along_z(0.05f, 0.05f), thread_));
  EXPECT_TRUE(accel.closest(along_z(1.95f), thread_));
  EXPECT_FALSE(accel.closest(along_z(2.05f), thread_));
  EXPECT_FALSE(accel.closest(along_z(-0.05f), thread_));
}

TEST_F(EmbreeAccelTest, StackedStrandsMultiply) {
  const Strands strands = ladder(6);
  const std::vector<float> opacity(strands.point_count(), 0.25f);
  for (CurveShape shape : {CurveShape::kFlat, CurveShape::kRound}) {
    EmbreeOptions options;
    options.shape = shape;
    const EmbreeAccel accel = make({{&strands, 0, opacity}}, {}, options);
    // Everywhere, also where two segments meet: each crossing counts once.
    for (float x = 0.5f; x <= 6.5f; x += 0.0625f) {
      EXPECT_NEAR(accel.transmittance(along_z(x), thread_), std::pow(0.75f, 6.0f), 1e-5f) << x;
    }
    Ray part = along_z(2.5f);
    part.far = 3.5f;  // past z = 0, 1 and 2
    EXPECT_NEAR(accel.transmittance(part, thread_), std::pow(0.75f, 3.0f), 1e-5f);
  }
}

TEST_F(EmbreeAccelTest, ManyCrossingsMultiplyToo) {
  const Strands strands = ladder(60);  // more than fit the list that needs no memory
  const std::vector<float> opacity(strands.point_count(), 0.05f);
  const EmbreeAccel accel = make({{&strands, 0, opacity}});
  EXPECT_NEAR(accel.transmittance(along_z(2.3f), thread_), std::pow(0.95f, 60.0f), 1e-5f);
}

TEST_F(EmbreeAccelTest, CrossingsStopRaysAsOftenAsTheirOpacitySays) {
  const Strands strands = ladder(3);
  const std::vector<float> opacity(strands.point_count(), 0.4f);
  const SkinMesh wall = quad(10);
  const EmbreeAccel accel = make({{&strands, 0, opacity}}, {&wall});
  constexpr int kRays = 20000;
  int stops[4] = {};
  for (int i = 0; i < kRays; ++i) {
    Ray ray = along_z(3.0f);  // at a joint
    ray.random = static_cast<uint32_t>(i);
    const Hit hit = accel.closest(ray, thread_);
    ASSERT_TRUE(hit);
    ++stops[hit.kind == HitKind::kSkin ? 3 : hit.strand_id];
  }
  double reach = 1;
  for (int k = 0; k < 4; ++k) {
    const double p = k < 3 ? reach * 0.4 : reach;
    EXPECT_NEAR(stops[k], kRays * p, 4.5 * std::sqrt(kRays * p * (1 - p))) << k;
    reach *= 0.6;
  }
  EXPECT_EQ(accel.transmittance(along_z(3.0f), thread_), 0.0f);  // the wall is opaque
}

TEST_F(EmbreeAccelTest, EqualDistancesAreDecidedByStrandId) {
  const Strands older = ladder(2, 3), younger = ladder(2, 8);
  for (bool swapped : {false, true}) {
    const EmbreeAccel accel =
        swapped ? make({{&younger, 0, {}}, {&older, 0, {}}}) : make({{&older, 0, {}}, {&younger, 0, {}}});
    for (float x = 0.1f; x < 6.9f; x += 0.05f) {
      const Hit hit = accel.closest(along_z(x), thread_);
      ASSERT_TRUE(hit);
      EXPECT_LT(hit.strand_id, 8u) << x;
    }
  }
}

TEST_F(EmbreeAccelTest, HitsDoNotDependOnThreadsOrTreeLayout) {
  RandomStrandOptions o;
  o.strands = 3000;
  o.radius = 0.01f;
  const Strands strands = random_strands(23, o);
  const EmbreeAccel many = make({{&strands, 0, {}}});
  EmbreeOptions compact;
  compact.compact = true;
  const EmbreeAccel small = make({{&strands, 0, {}}}, {}, compact);
  const EmbreeAccel single({{&strands, 0, {}}}, {}, {}, Workers(1));
  int hits = 0;
  for (uint64_t i = 0; i < 5000; ++i) {
    const Ray ray = random_ray(31, i);
    const Hit a = many.closest(ray, thread_);
    hits += static_cast<bool>(a);
    for (const EmbreeAccel* other : {&small, &single}) {
      const Hit b = other->closest(ray, thread_);
      ASSERT_EQ(a.kind, b.kind);
      ASSERT_EQ(a.strand_id, b.strand_id);
      ASSERT_EQ(a.segment, b.segment);
      ASSERT_EQ(a.distance, b.distance);
      ASSERT_EQ(a.u, b.u);
      ASSERT_EQ(a.v, b.v);
    }
  }
  EXPECT_GT(hits, 1000);
}

TEST_F(EmbreeAccelTest, SkinsMoveWithTheirKeys) {
  SkinMesh mesh = quad(1);
  const SkinMesh later = quad(3);
  mesh.motion_keys = 2;
  mesh.positions.insert(mesh.positions.end(), later.positions.begin(), later.positions.end());
  mesh.normals.insert(mesh.normals.end(), later.normals.begin(), later.normals.end());
  const EmbreeAccel accel = make({}, {&mesh});
  for (float time : {0.0f, 0.25f, 1.0f}) {
    Ray ray = along_z(1, 0.5f);
    ray.time = time;
    const Hit hit = accel.closest(ray, thread_);
    ASSERT_EQ(hit.kind, HitKind::kSkin);
    EXPECT_NEAR(hit.distance, 2 + 2 * time, 1e-5f);
  }
  EXPECT_EQ(accel.bounds().max.z, 3.0f);
}

TEST_F(EmbreeAccelTest, NothingIsMetWhereNothingIs) {
  const EmbreeAccel empty = make({});
  EXPECT_FALSE(empty.closest(along_z(0), thread_));
  EXPECT_EQ(empty.transmittance(along_z(0), thread_), 1.0f);
  EXPECT_TRUE(empty.bounds().isEmpty());

  const Strands none;
  const Strands points = ladder(2, 0, 1);  // too few points for a segment
  const SkinMesh no_triangles;
  const EmbreeAccel hollow = make({{&none, 0, {}}, {&points, 0, {}}}, {&no_triangles});
  EXPECT_FALSE(hollow.closest(along_z(0), thread_));
}

TEST_F(EmbreeAccelTest, RaysThatAreNotFiniteMeetNothing) {
  const Strands strands = ladder(2);
  const EmbreeAccel accel = make({{&strands, 0, {}}});
  for (float bad : {std::numeric_limits<float>::quiet_NaN(), std::numeric_limits<float>::infinity()}) {
    for (int part = 0; part < 3; ++part) {
      Ray ray = along_z(3);
      ASSERT_TRUE(accel.closest(ray, thread_));
      if (part == 0) ray.origin.y = bad;
      if (part == 1) ray.direction.x = bad;
      if (part == 2) ray.time = bad;
      EXPECT_FALSE(accel.closest(ray, thread_));
      EXPECT_EQ(accel.transmittance(ray, thread_), 1.0f);
    }
  }
}

}  // namespace
}  // namespace pelage
