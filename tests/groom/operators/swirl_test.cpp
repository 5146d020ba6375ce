// SPDX-License-Identifier: Apache-2.0
#include "groom/operators/swirl.h"

#include "tests/groom/operator_harness.h"

namespace pelage::swirl_test {
namespace {

class SwirlTest : public OperatorTest {
 protected:
  static SwirlParams on_top(float angle) {
    SwirlParams params;
    params.center = {0, 3, 0};
    params.radius = 0.8f;
    params.angle = Field(angle);
    params.lift = Field(0.0f);
    return params;
  }
};

TEST_F(SwirlTest, Bounds) {
  check_bounds(prepared<Swirl>(on_top(90)), {1.5f, 1.5f, 0, 1.2f});
  SwirlParams bent = on_top(-30);
  bent.curve = 0.5f;
  bent.amount = Field(0.7f);
  check_bounds(prepared<Swirl>(bent), {1.5f, 1.5f, 0});
}

TEST_F(SwirlTest, StrandsRunAroundTheCentre) {
  for (const float angle : {0.0f, 90.0f, -60.0f}) {
    const Swirl op = prepared<Swirl>(on_top(angle));
    size_t inside = 0;
    for (size_t first = 0; first < follicles_.size(); first += kBlockStrands) {
      auto batch = straight(first), before = straight(first);
      op.apply(*batch);
      for (size_t s = 0; s < batch->count; ++s) {
        const V3f root = vector_at(batch->rest.position, s), normal = vector_at(batch->rest.normal, s);
        const V3f tip = batch->offset(7, s);
        const float distance = std::sqrt(root.x * root.x + root.z * root.z);
        if (root.y < 0 || distance > 0.85f) {
          EXPECT_EQ(tip, before->offset(7, s)) << root;
        } else if (distance > 0.1f && distance < 0.3f) {
          const V3f away(root.x, 0, root.z), out = (away - normal * away.dot(normal)).normalized();
          const float turn = angle * std::numbers::pi_v<float> / 180;
          EXPECT_NEAR(tip.dot(out), std::cos(turn), 0.02f) << root;
          EXPECT_NEAR(tip.dot(normal.cross(out)), std::sin(turn), 0.02f) << root;
          ++inside;
        }
        EXPECT_NEAR(length_of(*batch, s), 1, 1e-5f);
      }
    }
    EXPECT_GT(inside, 20u);
  }
}

}  // namespace
}  // namespace pelage::swirl_test
