// SPDX-License-Identifier: Apache-2.0
#include "groom/strands/work_batch.h"

#include <cmath>
#include <cstring>
#include <thread>

#include "tests/groom/cached_coats.h"

namespace pelage::work_batch_test {
namespace {

/// Leaves numbers that are not numbers in the memory that the next batches of this thread reuse.
void spoil_memory() {
  constexpr float kNone = std::numeric_limits<float>::quiet_NaN();
  const WorkBatch a, b;
  for (StrandBatch* batch : {&*a, &*b}) {
    batch->count = kBlockStrands;
    batch->points.resize(12);
    batch->colors.resize(12);
    batch->scale = kNone;
    batch->posed = true;
    std::vector<StrandRow*> rows{&batch->u, &batch->v, &batch->face_u, &batch->face_v, &batch->clump};
    const auto add = [&](VectorRow& row) {
      for (StrandRow& axis : row) rows.push_back(&axis);
    };
    for (RootRows* roots : {&batch->rest, &batch->current}) {
      for (VectorRow* row : {&roots->position, &roots->tangent, &roots->bitangent, &roots->normal}) add(*row);
    }
    for (VectorRow& color : batch->colors) add(color);
    for (StrandBatch::PointRows& point : batch->points) {
      add(point.offset);
      rows.push_back(&point.radius);
    }
    for (StrandRow* row : rows) row->fill(kNone);
    batch->ids.fill(~uint64_t(0));
    batch->face.fill(~uint32_t(0));
  }
}

class WorkBatchTest : public CachedCoatTest {
 protected:
  /// What grow() returns in a thread that has no earlier batches, and in one whose batches are spoilt.
  static void expect_equal(const Groom& groom, const PosedSkin& pose, const KeptStrands* kept) {
    for (size_t leaf = 0; leaf < groom.follicles().leaves().size(); ++leaf) {
      Strands fresh, reused;
      std::thread([&] { fresh = groom.grow(leaf, pose, kept); }).join();
      spoil_memory();
      reused = groom.grow(leaf, pose, kept);
      const auto same = [](const auto& a, const auto& b) {
        return a.size() == b.size() && std::memcmp(a.data(), b.data(), a.size() * sizeof(a[0])) == 0;
      };
      EXPECT_TRUE(same(fresh.arrays().points, reused.arrays().points)) << leaf;
      EXPECT_TRUE(same(fresh.arrays().ids, reused.arrays().ids)) << leaf;
      EXPECT_TRUE(same(fresh.arrays().root_uv, reused.arrays().root_uv)) << leaf;
      ASSERT_EQ(fresh.attributes().size(), reused.attributes().size());
      for (size_t a = 0; a < fresh.attributes().size(); ++a)
        EXPECT_TRUE(same(fresh.attributes()[a].values, reused.attributes()[a].values)) << leaf;
      for (const float x : reused.points()) ASSERT_TRUE(std::isfinite(x)) << leaf;
    }
  }
};

TEST_F(WorkBatchTest, GrowthDoesNotDependOnReusedMemory) {
  const std::string operators =
      "- length: {value: 0.4, variation: 0.3}\n"
      "- comb: {direction: [0, -1, 0.3], lift: 0.3}\n"
      "- clump: {spacing: 0.3, amount: 0.6}\n"
      "- frizz: {amplitude: 0.02, frequency: 3}\n"
      "- width: {root: 0.008, tip: 0.001, variation: 0.2}\n";
  const std::string colors =
      "- color: {value: {ramp: {along: strand, knots: [[0, [0, 1, 0]], [1, [1, 0, 0]]]}}, variation: 0.5}\n";
  const LimitSurface keys[] = {*rest_, *rest_};
  const std::vector<uint32_t> strands{0, 3, 4, 260};
  const std::vector<float> widths(strands.size(), 1.5f);
  const KeptStrands few{strands, widths, {}};
  for (const char* freeze : {"", "width", "frizz"}) {
    for (const std::string& more : {std::string(), colors}) {
      const auto groom = make(params_of({operators + more, freeze, 900, 300}));
      for (const size_t count : {size_t(1), size_t(2)}) {
        PosedSkin pose;
        pose.keys = {keys, count};
        pose.scale = 1.5f;
        expect_equal(*groom, pose, nullptr);
        expect_equal(*groom, pose, &few);
      }
    }
  }
}

TEST_F(WorkBatchTest, NestedBatchesAreDifferent) {
  const WorkBatch a, b, c;
  EXPECT_NE(&*a, &*b);
  EXPECT_NE(&*b, &*c);
  EXPECT_NE(&*a, &*c);
}

TEST_F(WorkBatchTest, KeepsNoLongStrands) {
  static constexpr size_t kMany = WorkBatch::kMaxKept / sizeof(StrandBatch::PointRows);
  std::thread([] {
    { WorkBatch()->points.resize(kMany); }
    EXPECT_LT(WorkBatch()->points.capacity(), kMany);
    { WorkBatch()->points.resize(8); }
    EXPECT_EQ(WorkBatch()->points.size(), 8u);
  }).join();
}

}  // namespace
}  // namespace pelage::work_batch_test
