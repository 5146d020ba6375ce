// SPDX-License-Identifier: Apache-2.0
#include "groom/operators/follow.h"

#include <algorithm>
#include <utility>
#include <vector>

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

/// What Follow does, one strand after the other: the sum of all its guides' turns, by distance.
std::vector<V3f> followed(const StrandBatch& batch, size_t s, const MovingGuides& guides,
                          const GuideTurns& turns, size_t neighbours) {
  const V3f root = vector_at(batch.rest.position, s), normal = vector_at(batch.rest.normal, s);
  std::vector<std::pair<float, uint32_t>> near;
  for (uint32_t g = 0; g < guides.follicles.size(); ++g) {
    const float distance = (guides.roots.position(g) - root).length();
    if (distance <= guides.roots.radius() && RootGrid::same_side(guides.roots.normal(g), normal))
      near.emplace_back(distance, g);
  }
  std::sort(near.begin(), near.end());
  const float radius = near.size() > neighbours ? near[neighbours].first : guides.roots.radius();
  near.resize(std::min(near.size(), neighbours));
  const auto segments = static_cast<size_t>(batch.segment_count());
  std::vector<V3f> points{batch.offset(0, s)};
  for (size_t p = 0; p < segments; ++p) {
    V3f v(0);
    float w = 0;
    for (const auto& [distance, g] : near) {
      const float* q = &turns[4 * (g * segments + p)];
      const float* first = &turns[4 * (near[0].second * segments + p)];
      const float x = std::max(0.0f, 1 - distance / radius);
      const bool same = q[0] * first[0] + q[1] * first[1] + q[2] * first[2] + q[3] * first[3] >= 0;
      const float weight = same ? x * x : -x * x;
      v += weight * V3f(q[0], q[1], q[2]);
      w += weight * q[3];
    }
    V3f segment = batch.offset(static_cast<int>(p) + 1, s) - batch.offset(static_cast<int>(p), s);
    if (const float size2 = v.length2() + w * w; size2 > 0) {
      const V3f t = 2.0f * v.cross(segment);
      segment += (w * t + v.cross(t)) / size2;
    }
    points.push_back(points.back() + segment);
  }
  return points;
}

TEST_F(FollowTest, TurnsEachStrandByItsNearestGuides) {
  for (size_t i = 0; i < turns_.size(); i += 8) {  // turns of both signs mean the same
    for (size_t k = 0; k < 4; ++k) turns_[i + k] = -turns_[i + k];
  }
  for (const size_t neighbours : {1, 3, 4, 5, 8}) {
    const Follow op(static_cast<int>(neighbours), guides_, "");
    for (const size_t count : {size_t{kBlockStrands}, size_t{255}, size_t{1}}) {
      auto batch = random_strands({}, 0, 5);
      batch->count = std::min(batch->count, count);
      const auto before = std::make_unique<StrandBatch>(*batch);
      batch->turns = &turns_;
      op.apply(*batch);
      for (size_t s = 0; s < batch->count; ++s) {
        const std::vector<V3f> expected = followed(*before, s, *guides_, turns_, neighbours);
        for (int p = 0; p < batch->point_count(); ++p)
          ASSERT_LT((batch->offset(p, s) - expected[static_cast<size_t>(p)]).length(), 2e-5f)
              << neighbours << " guides, strand " << s << ", point " << p;
      }
    }
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
