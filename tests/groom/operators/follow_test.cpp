// SPDX-License-Identifier: Apache-2.0
#include "groom/operators/follow.h"

#include "tests/groom/operator_harness.h"

namespace pelage {
namespace follow_test {

/// Strands among 40 guides with random turns.
class FollowTest : public OperatorTest {
 protected:
  static constexpr size_t kGuides = 40, kSegments = 7;
  FollowTest() {
    guides_->place(kGuides, follicles_, *rest_);
    TestRandom random(3);
    for (size_t i = 0; i < kGuides * kSegments; ++i) {
      const V3f axis = random.direction() * std::sin(random.unit());
      turns_.insert(turns_.end(), {axis.x, axis.y, axis.z, std::sqrt(1 - axis.length2())});
      still_.insert(still_.end(), {0, 0, 0, 1});
    }
  }
  std::shared_ptr<MovingGuides> guides_ = std::make_shared<MovingGuides>();
  GuideTurns turns_, still_;
};

TEST_F(FollowTest, GuidesAreTheFirstStrandsOfTheCoat) {
  ASSERT_EQ(guides_->follicles.size(), kGuides);
  for (size_t g = 0; g < kGuides; ++g) EXPECT_EQ(follicles_.id(guides_->follicles[g]), g);
}

TEST_F(FollowTest, SegmentsKeepTheirLengthsAndBounds) {
  const Follow op(4, guides_, "");
  size_t seen = 0;
  for (size_t first = 0; first < follicles_.size(); first += kBlockStrands) {
    auto batch = random_strands({}, first, first);
    const auto before = std::make_unique<StrandBatch>(*batch);
    batch->turns = &turns_;
    op.apply(*batch);
    const StrandReach after = op.reach_after({});
    for (size_t s = 0; s < batch->count; ++s) {
      seen += batch->ids[s] < kGuides;
      for (int p = 1; p <= static_cast<int>(kSegments); ++p) {
        const V3f was = before->offset(p, s) - before->offset(p - 1, s);
        const V3f now = batch->offset(p, s) - batch->offset(p - 1, s);
        EXPECT_NEAR(now.length(), was.length(), 1e-5f);
        EXPECT_LE(batch->offset(p, s).length(), after.distance);
      }
    }
  }
  EXPECT_EQ(seen, kGuides);
}

TEST_F(FollowTest, ASingleGuideTurnsItsStrandExactly) {
  const Follow op(1, guides_, "");
  auto batch = straight();
  const auto before = std::make_unique<StrandBatch>(*batch);
  batch->turns = &turns_;
  op.apply(*batch);
  for (size_t s = 0; s < batch->count; ++s) {
    const uint64_t id = batch->ids[s];
    if (id >= kGuides) continue;
    const float* q = &turns_[4 * id * kSegments];
    const V3f v(q[0], q[1], q[2]), x = before->offset(1, s), t = v.cross(x) * 2.0f;
    EXPECT_LT((batch->offset(1, s) - (x + t * q[3] + v.cross(t))).length(), 1e-5f);
  }
}

TEST_F(FollowTest, StillGuidesChangeNoBit) {
  const Follow op(4, guides_, "");
  auto batch = random_strands({}, 0, 5);
  const auto before = std::make_unique<StrandBatch>(*batch);
  op.apply(*batch);  // without turns
  batch->turns = &still_;
  op.apply(*batch);
  for (size_t s = 0; s < batch->count; ++s) {
    for (int p = 0; p < batch->point_count(); ++p) EXPECT_EQ(batch->offset(p, s), before->offset(p, s));
  }
}

}  // namespace follow_test
}  // namespace pelage
