// SPDX-License-Identifier: Apache-2.0
#include "groom/operators/push_out.h"

#include "geom/closest_point.h"
#include "geom/tessellation.h"
#include "tests/groom/operator_harness.h"

namespace pelage {
namespace {

class PushOutTest : public OperatorTest {
 protected:
  PushOutTest() : mesh_(tessellate(std::span(rest_.get(), 1), view(), {4, 8}, workers_)), tree_(mesh_, 0) {}

  static View view() {
    View everywhere;
    everywhere.focal_pixels = 1e9f;
    return everywhere;
  }
  /// Strands over the skin in its rest pose.
  void on_skin(StrandBatch& batch) const {
    batch.skin = &tree_;
    carry_to_pose(batch, 1);
  }

  /// Points of the pinned B-spline of a strand, 8 to a segment.
  static std::vector<V3f> curve_of(const StrandBatch& batch, size_t s) {
    std::vector<V3f> points;
    const int last = batch.point_count() - 1;
    const V3f root = vector_at(batch.current.position, s);
    const auto at = [&](int p) {
      if (p < 0) return batch.offset(0, s) * 2.0f - batch.offset(1, s);
      if (p > last) return batch.offset(last, s) * 2.0f - batch.offset(last - 1, s);
      return batch.offset(p, s);
    };
    for (int k = 0; k < last; ++k) {
      for (int i = 1; i <= 8; ++i) {
        const float t = static_cast<float>(i) / 8, u = 1 - t;
        points.push_back(root + (at(k - 1) * (u * u * u) + at(k) * (3 * t * t * t - 6 * t * t + 4) +
                                 at(k + 1) * (3 * u * u * u - 6 * u * u + 4) + at(k + 2) * (t * t * t)) /
                                    6.0f);
      }
    }
    return points;
  }

  SkinMesh mesh_;
  ClosestPointTree tree_;
};

TEST_F(PushOutTest, NoCurveEntersTheSkin) {
  const PushOut op = prepared<PushOut>({.offset = Field(0.05f), .iterations = 4});
  const StrandReach any{0.8f, 0.8f, 0, std::numbers::pi_v<float>, 7};
  int kept = 0, strands = 0;
  for (size_t round = 0; round < 4; ++round) {
    auto batch = random_strands(any, round * kBlockStrands, round);
    StrandRow before;
    arc_lengths(*batch, before);
    on_skin(*batch);
    op.apply(*batch);
    for (size_t s = 0; s < batch->count; ++s) {
      for (const V3f& point : curve_of(*batch, s)) {
        ClosestPoint nearest;
        ASSERT_TRUE(tree_.closest(point, 10, nearest));
        EXPECT_TRUE(!nearest.inside || nearest.distance < 1e-4f) << nearest.distance << " inside";
      }
      ++strands;
      const float length = length_of(*batch, s);
      EXPECT_LT(length, 3 * before[s] + 0.2f);
      kept += std::fabs(length - before[s]) < 0.1f * before[s];
    }
  }
  EXPECT_GT(kept, strands / 2);  // of strands in all directions, half of them straight in
}

TEST_F(PushOutTest, LeavesStrandsAloneThatAreClear) {
  const PushOut op = prepared<PushOut>({.offset = Field(0.0f), .iterations = 4});
  auto batch = straight();
  on_skin(*batch);
  const StrandBatch before = *batch;
  op.apply(*batch);
  for (size_t s = 0; s < batch->count; ++s) {
    for (int p = 0; p < 8; ++p) EXPECT_LT((batch->offset(p, s) - before.offset(p, s)).length(), 1e-6f);
  }
}

TEST_F(PushOutTest, KeepsADistance) {
  // Strands flat along the skin end up at the offset.
  const PushOut op = prepared<PushOut>({.offset = Field(0.03f), .iterations = 6});
  auto batch = straight();
  for (size_t s = 0; s < batch->count; ++s) {
    const Frame frame = batch->rest.frame(s);
    for (int p = 1; p < 8; ++p) batch->set_offset(p, s, frame.tangent * (0.5f * batch->along(p)));
  }
  on_skin(*batch);
  op.apply(*batch);
  for (size_t s = 0; s < batch->count; ++s) {
    EXPECT_NEAR(length_of(*batch, s), 0.5f, 0.05f);
    for (int p = 2; p < 8; ++p) {
      ClosestPoint nearest;
      ASSERT_TRUE(tree_.closest(vector_at(batch->current.position, s) + batch->offset(p, s), 10, nearest));
      EXPECT_GT(nearest.distance, 0.029f);
    }
  }
}

TEST_F(PushOutTest, Bound) {
  const PushOut op = prepared<PushOut>({.offset = Field(0.02f), .iterations = 4});
  const StrandReach before{0.2f, 0.2f, 0, std::numbers::pi_v<float>, 7};  // short: the skin is nearly flat
  const float reach = op.reach_after(before).distance;
  float measured = 0;
  for (size_t round = 0; round < 8; ++round) {
    auto batch = random_strands(before, round * kBlockStrands, round);
    for (size_t s = 0; s < batch->count; s += 8) {  // straight in, the worst that a strand can do
      const V3f normal = vector_at(batch->rest.normal, s);
      for (int p = 1; p < 8; ++p) batch->set_offset(p, s, normal * (-before.length * batch->along(p)));
    }
    on_skin(*batch);
    op.apply(*batch);
    for (size_t s = 0; s < batch->count; ++s) {
      for (int p = 0; p < 8; ++p) measured = std::max(measured, batch->offset(p, s).length());
    }
  }
  EXPECT_LE(measured, reach * 1.001f);
  EXPECT_GT(measured, reach / 1.5f);
}

}  // namespace
}  // namespace pelage
