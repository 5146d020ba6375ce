// SPDX-License-Identifier: Apache-2.0
#include "groom/operators/braid.h"

#include <map>

#include "tests/groom/operator_harness.h"

namespace pelage::braid_test {
namespace {

class BraidTest : public OperatorTest {
 protected:
  static BraidParams thin(BraidStyle style) {
    BraidParams params;
    params.style = style;
    params.spacing = 0.4f;
    params.radius = Field(0.05f);
    params.pitch = 0.5f;
    params.thickness = 0;
    return params;
  }
};

TEST_F(BraidTest, Bounds) {
  check_bounds(prepared<Braid>(thin(BraidStyle::kBraid)), {1.2f, 1.2f, 0, 1.0f});
  check_bounds(prepared<Braid>(thin(BraidStyle::kTwist)), {1.2f, 1.2f, 0});
}

TEST_F(BraidTest, StrandsOfAClumpFormItsPlies) {
  for (const BraidStyle style : {BraidStyle::kBraid, BraidStyle::kTwist}) {
    const int points = 33;
    const Braid op = prepared<Braid>(thin(style), points);
    auto batch = straight(0, points);
    op.apply(*batch);
    std::map<float, std::vector<V3f>> middle;  // by clump: points at about the same height
    for (size_t s = 0; s < batch->count; ++s) {
      EXPECT_LE(length_of(*batch, s), 1 + 1e-5f);
      EXPECT_GT(length_of(*batch, s), 0.8f);
      middle[batch->clump[s]].push_back(vector_at(batch->rest.position, s) + batch->offset(points - 1, s));
    }
    size_t pairs = 0, close = 0;
    for (const auto& [clump, tips] : middle) {
      for (size_t i = 0; i < tips.size(); ++i) {
        for (size_t j = 0; j < i; ++j) {
          ++pairs;
          EXPECT_LT((tips[i] - tips[j]).length(), 0.3f);
          close += (tips[i] - tips[j]).length() < 0.05f;
        }
      }
    }
    EXPECT_GT(pairs, 100u);
    // Three plies: about every third pair is in the same one.
    EXPECT_GT(close, pairs / 15);
    EXPECT_LT(close, pairs * 2 / 3);
  }
}

TEST_F(BraidTest, AmountZeroChangesNothing) {
  BraidParams params = thin(BraidStyle::kTwist);
  params.amount = Field(0.0f);
  auto batch = straight();
  prepared<Braid>(params).apply(*batch);
  for (size_t s = 0; s < batch->count; ++s)
    EXPECT_LT((batch->offset(7, s) - straight()->offset(7, s)).length(), 1e-6f);
}

}  // namespace
}  // namespace pelage::braid_test
