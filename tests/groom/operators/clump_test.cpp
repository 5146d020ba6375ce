// SPDX-License-Identifier: Apache-2.0
#include "groom/operators/clump.h"

#include "groom/operators/comb.h"
#include "tests/groom/operator_harness.h"

namespace pelage::clump_test {
namespace {

using ClumpTest = OperatorTest;

ClumpParams params(float spacing, float amount) {
  ClumpParams p;
  p.spacing = spacing;
  p.amount = Field(amount);
  return p;
}

TEST_F(ClumpTest, Bounds) {
  check_bounds(prepared<Clump>(params(0.4f, 0.6f)), {1.2f, 1.2f, 0});
  check_bounds(prepared<Clump>(params(0.1f, 1)), {1.2f, 1.2f, 0});
  check_bounds(prepared<Clump>(params(0.1f, 0.1f)), {1.2f, 1.2f, 0});
  check_bounds(prepared<Clump>(params(0.05f, 0.3f)), {0.5f, 0.5f, 0});
  ClumpParams two = params(0.4f, 0.4f);
  two.levels.push_back({0.15f, Field(0.4f)});
  check_bounds(prepared<Clump>(two), {1.2f, 1.2f, 0});
}

TEST_F(ClumpTest, TipsMeetAndLengthsStay) {
  ClumpParams full = params(0.3f, 1);
  const Clump op = prepared<Clump>(full);
  // Tips of strands of one clump come together: each finds another's within a fraction of the distance of
  // roots.
  double before = 0, after = 0;
  auto batch = straight();
  const StrandBatch standing = *batch;
  op.apply(*batch);
  int pairs = 0;
  for (size_t s = 0; s < batch->count; ++s) {
    EXPECT_LE(length_of(*batch, s), 1.0f + 1e-4f);
    EXPECT_GT(length_of(*batch, s), 0.95f);
    for (size_t t = 0; t < s; ++t) {
      if (batch->clump[s] != batch->clump[t]) continue;
      const V3f roots = vector_at(batch->rest.position, s) - vector_at(batch->rest.position, t);
      before += (roots + standing.offset(7, s) - standing.offset(7, t)).length();
      after += (roots + batch->offset(7, s) - batch->offset(7, t)).length();
      ++pairs;
    }
  }
  ASSERT_GT(pairs, 100);
  EXPECT_LT(after, 0.15 * before);
}

TEST_F(ClumpTest, LevelsClumpWithinClumps) {
  ClumpParams two = params(0.5f, 0.5f);
  two.levels.push_back({0.12f, Field(1.0f)});
  const Clump op = prepared<Clump>(two);
  auto batch = straight(0, 8, kBlockStrands);
  op.apply(*batch);
  // Fine clumps are closed; their tips lie nearer each other than when only the fine level works.
  ClumpParams fine = params(0.12f, 1.0f);
  const int64_t of_two = ledger_.current(MemoryTag::kGrooms);
  const Clump one = prepared<Clump>(fine);
  const int64_t of_one = ledger_.current(MemoryTag::kGrooms) - of_two;
  EXPECT_GT(of_one, 0);
  EXPECT_GT(of_two, of_one);
  float nearest = 10;
  for (size_t s = 1; s < batch->count; ++s) {
    if (batch->clump[s] != batch->clump[0]) continue;
    const V3f roots = vector_at(batch->rest.position, s) - vector_at(batch->rest.position, 0);
    nearest = std::min(nearest, (roots + batch->offset(7, s) - batch->offset(7, 0)).length());
  }
  EXPECT_LT(nearest, 0.05f);
}

TEST_F(ClumpTest, CentresGrowByTheOperatorsBefore) {
  // Combed strands, clumped at the tips, still lie as combed: the centres have been combed too.
  std::vector<std::unique_ptr<Operator>> before;
  before.push_back(
      std::make_unique<Comb>(CombParams{.direction = Field(Rgb(0, -1, 0)), .lift = Field(0.2f)}));
  before[0]->prepare(context());
  PrepareContext own = context();
  own.preceding = before;
  Clump op(params(0.2f, 0.8f));
  op.prepare(own);
  auto batch = straight();
  before[0]->apply(*batch);
  const StrandBatch combed = *batch;
  op.apply(*batch);
  double turned = 0;
  for (size_t s = 0; s < batch->count; ++s) {
    turned += std::acos(
        std::clamp(batch->offset(7, s).normalized().dot(combed.offset(7, s).normalized()), -1.0f, 1.0f));
  }
  EXPECT_LT(turned / static_cast<double>(batch->count), 0.25);
}

TEST_F(ClumpTest, RefusesAbsurdSpacing) {
  Clump op(params(1e-5f, 1));
  EXPECT_THROW(op.prepare(context()), Error);
}

}  // namespace
}  // namespace pelage::clump_test
