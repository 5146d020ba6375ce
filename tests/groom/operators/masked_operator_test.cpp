// SPDX-License-Identifier: Apache-2.0
#include "groom/operators/masked_operator.h"

#include <cstring>

#include "groom/groom.h"
#include "groom/strands/strand_fields.h"
#include "tests/groom/operator_harness.h"
#include "tests/groom/scene_text.h"

namespace pelage::masked_operator_test {
namespace {

class MaskedOperators : public OperatorTest {
 protected:
  std::unique_ptr<Operator> masked(const std::string& line) {
    const auto list = scene_text::read<OperatorList>("- " + line + "\n");
    std::unique_ptr<Operator> op = list.items.front().clone(*list.items.front().prototype);
    op->prepare(context());
    return op;
  }
  std::unique_ptr<StrandBatch> grown(const std::string& line) {
    const auto op = masked(line);
    auto batch = straight();
    batch->colors.resize(op->traits().colors == AttributeClass::kPerPoint ? batch->points.size() : 1);
    clear_attributes(*batch);
    op->apply(*batch);
    return batch;
  }
};

bool same(const StrandRow& a, const StrandRow& b, size_t s) {
  return std::memcmp(&a[s], &b[s], sizeof(float)) == 0;
}

const char* const kOperators[] = {"length: {value: 0.5, variation: 0.5",
                                  "comb: {direction: [1, 0.2, 0], lift: 0.3",
                                  "bend: {direction: [0, -1, 0], angle: 120",
                                  "clump: {spacing: 0.5, amount: 0.7",
                                  "curl: {radius: 0.05, turns: 2",
                                  "frizz: {amplitude: 0.02",
                                  "noise: {amplitude: 0.1",
                                  "width: {root: 0.02, tip: 0.01",
                                  "color: {value: [1, 0.5, 0.2], variation: 0.3"};

TEST_F(MaskedOperators, KeepEveryBitWhereTheMaskIsZeroAndSetItWhereItIsOne) {
  const auto before = grown("length: {}");
  // Of a million, so that hardly any value is between 0 and 1.
  const std::string mask = "{noise: {frequency: 20, amplitude: 1e6}}";
  StrandRow values;
  evaluate(scene_text::read<Field>(mask), *before, 0, values);
  for (const std::string op : kOperators) {
    const auto after = grown(op + "}");
    const auto half = grown(op + ", mask: " + mask + "}");
    size_t kept = 0;
    for (size_t s = 0; s < half->count; ++s) {
      const bool on = values[s] >= 1;
      if (!on && values[s] > 0) continue;
      kept += on ? 0 : 1;
      const StrandBatch& right = on ? *after : *before;
      for (size_t p = 0; p < half->points.size(); ++p) {
        for (size_t axis = 0; axis < 3; ++axis)
          EXPECT_TRUE(same(half->points[p].offset[axis], right.points[p].offset[axis], s)) << op;
        EXPECT_TRUE(same(half->points[p].radius, right.points[p].radius, s)) << op;
      }
      for (size_t axis = 0; axis < 3; ++axis)
        EXPECT_TRUE(same(half->colors[0][axis], right.colors[0][axis], s)) << op;
      EXPECT_EQ(half->clump[s], right.clump[s]) << op;
    }
    EXPECT_GT(kept, 20u);
    EXPECT_LT(kept, half->count - 20);
  }
}

TEST_F(MaskedOperators, EveryOperatorHasAnAmountBesideItsMask) {
  const auto full = grown("noise: {amplitude: 0.1}"), half = grown("noise: {amplitude: 0.1, amount: 0.5}");
  const auto quarter = grown("noise: {amplitude: 0.1, amount: 0.5, mask: 0.5}"), before = grown("length: {}");
  for (size_t s = 0; s < full->count; ++s) {
    const V3f moved = full->offset(7, s) - before->offset(7, s);
    EXPECT_LT((half->offset(7, s) - before->offset(7, s) - moved * 0.5f).length(), 1e-6f);
    EXPECT_LT((quarter->offset(7, s) - before->offset(7, s) - moved * 0.25f).length(), 1e-6f);
  }
  for (const std::string op : kOperators) {
    const bool own = op.find("amount") != std::string::npos;
    const auto off = grown(op + (own ? ", mask: 0}" : ", amount: 0}"));
    for (size_t s = 0; s < off->count; ++s) EXPECT_EQ(off->offset(7, s), before->offset(7, s)) << op;
  }
}

TEST_F(MaskedOperators, InterpolateInBetweenAndAlongTheStrand) {
  const auto half = grown("length: {value: 0.5, mask: 0.5}");
  const auto tip =
      grown("width: {root: 0.2, tip: 0.2, mask: {ramp: {along: strand, knots: [[0, 0], [1, 1]]}}}");
  const auto color = grown("color: {value: 0, mask: {ramp: {along: strand, knots: [[0, 0], [1, 1]]}}}");
  ASSERT_EQ(color->colors.size(), 8u);
  for (size_t s = 0; s < half->count; ++s) {
    EXPECT_NEAR(length_of(*half, s), 0.75f, 1e-5f);
    for (size_t p = 0; p < 8; ++p) {
      EXPECT_NEAR(tip->points[p].radius[s], 0.1f * static_cast<float>(p) / 7, 1e-6f);
      EXPECT_NEAR(color->colors[p][0][s], 1 - static_cast<float>(p) / 7, 1e-6f);
    }
  }
}

TEST_F(MaskedOperators, FollowTheColorAlongTheStrand) {
  const auto op = masked("width: {root: 0.2, tip: 0.2, mask: {attribute: color}}");
  auto batch = straight();
  clear_attributes(*batch);
  batch->colors.resize(batch->points.size());
  for (size_t p = 0; p < 8; ++p) batch->colors[p][0].fill(static_cast<float>(p) / 7);
  op->apply(*batch);
  for (size_t p = 0; p < 8; ++p)
    EXPECT_NEAR(batch->points[p].radius[0], 0.1f * static_cast<float>(p) / 7, 1e-6f);
}

TEST_F(MaskedOperators, HideHowBrightAStrandIs) {
  const std::string dark = "color: {value: 0.4, variation: 0.9";
  EXPECT_TRUE(masked(dark + ", mask: {ramp: {along: x, knots: [[0, 0], [1, 1]]}}}")->traits().colors_partly);
  EXPECT_FALSE(masked(dark + ", mask: 1}")->traits().colors_partly);
  EXPECT_TRUE(masked(dark + ", mask: 1}")->traits().replaces_colors);
}

TEST_F(MaskedOperators, StayWithinTheirBounds) {
  StrandReach before;
  before.lean = 0.4f;
  before.radius = 0.01f;
  for (const std::string mask : {"0.5", "{ramp: {along: strand, knots: [[0, 0], [0.5, 1], [1, 0]]}}"}) {
    for (const std::string op : kOperators) {
      if (op.starts_with("color")) continue;
      check_bounds(*masked(op + ", mask: " + mask + "}"), before, 0);
    }
  }
}

TEST_F(MaskedOperators, LeaveTheDefaultWidthOutsideTheMask) {
  GroomParams params;
  params.strands = 50;
  params.operators = scene_text::read<OperatorList>("- width: {root: 0.5, tip: 0.5, mask: 0}\n");
  const auto groom = Groom::create("coat", params, rest_, textures_, job_);
  const Strands strands = groom->grow(0, {{rest_.get(), 1}, {}, 1, {}});
  for (size_t s = 0; s < strands.strand_count(); ++s) EXPECT_GT(strands.radius(strands.first_point(s)), 0);
  EXPECT_LT(strands.radius(0), 0.2f);
}

TEST_F(MaskedOperators, LimitWhereACoatGrows) {
  struct Nowhere final : Operator {
    OperatorTraits traits() const override { return {.name = "nowhere", .restricts_coverage = true}; }
    std::vector<ParameterText> parameters() const override { return {}; }
    float coverage(const FieldPoint&) const override { return 0; }
    void apply(StrandBatch&) const override {}
    StrandReach reach_after(const StrandReach& before) const override { return before; }
  };
  const MaskedOperator op(
      std::make_shared<Nowhere>(),
      [](const Operator&) -> std::unique_ptr<Operator> { return std::make_unique<Nowhere>(); }, Field(0.25f));
  EXPECT_TRUE(op.traits().restricts_coverage);
  EXPECT_EQ(op.coverage({}), 0.75f);
}

}  // namespace
}  // namespace pelage::masked_operator_test
