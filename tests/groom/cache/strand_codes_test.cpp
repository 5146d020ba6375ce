// SPDX-License-Identifier: Apache-2.0
#include "groom/cache/strand_codes.h"

#include <cmath>
#include <functional>
#include <memory>

#include <gtest/gtest.h>

#include "groom/cache/frozen_leaf_writer.h"
#include "groom/cache/small_float.h"
#include "tests/groom/operator_harness.h"

namespace pelage {
namespace {

TEST(SmallFloatTest, KeepsOnePartInTwoThousand) {
  TestRandom random(1);
  for (int i = 0; i < 20000; ++i) {
    const float value = std::exp2(random.between(-43.9f, 19.9f));
    const auto near = small_float::nearest(value), above = small_float::not_below(value);
    ASSERT_TRUE(near && above);
    EXPECT_LE(std::fabs(small_float::decode(*near) - value), value * 0x1p-11f);
    EXPECT_GE(small_float::decode(*above), value);
    EXPECT_LE(small_float::decode(*above), value * (1 + 0x1p-10f));
  }
}

TEST(SmallFloatTest, KnowsItsEnds) {
  EXPECT_EQ(small_float::decode(*small_float::nearest(0)), 0.0f);
  EXPECT_EQ(small_float::decode(*small_float::nearest(1)), 1.0f);
  EXPECT_EQ(small_float::decode(*small_float::nearest(1e-20f)), 0.0f);
  EXPECT_GT(small_float::decode(*small_float::not_below(1e-20f)), 1e-20f);
  for (const float none : {-1.0f, 2e6f, INFINITY, NAN}) {
    EXPECT_FALSE(small_float::nearest(none));
    EXPECT_FALSE(small_float::not_below(none));
  }
}

class StrandCodesTest : public testing::Test {
 protected:
  static constexpr int kPoints = 6;
  StrandCodesTest() {
    batch_->count = 200;
    TestRandom random(2);
    for (size_t s = 0; s < batch_->count; ++s) {
      batch_->ids[s] = s * 7;
      Frame frame;
      frame.normal = random.direction();
      frame.tangent = frame.normal.cross(V3f(0.1f, 0.2f, 1)).normalized();
      frame.bitangent = frame.normal.cross(frame.tangent);
      batch_->rest.set(s, random.direction(), frame);
      batch_->clump[s] = random.unit();
    }
    start_strands(*batch_, kPoints);
    batch_->colors.resize(kPoints);
    for (size_t s = 0; s < batch_->count; ++s) {
      V3f at(0);
      for (int p = 0; p < kPoints; ++p) {
        if (p > 0) batch_->set_offset(p, s, at += random.direction() * random.unit());
        batch_->points[static_cast<size_t>(p)].radius[s] = 0.01f * random.unit();
        set_vector(batch_->colors[static_cast<size_t>(p)], s,
                   V3f(random.unit(), 0.1f * random.unit(), random.between(-0.5f, 1)));
      }
    }
  }

  struct Decoded {
    FrozenLeaf::Block block;
    std::unique_ptr<StrandBatch> batch;
  };
  Decoded through_codes(const CodeOptions& options) const {
    FrozenLeafWriter writer(options);
    writer.add(*batch_);
    const std::vector<std::byte> bytes = writer.finish();
    const std::optional<FrozenLeaf> leaf = FrozenLeaf::read(bytes);
    Decoded decoded{leaf->blocks().front(), std::make_unique<StrandBatch>(*batch_)};
    clear_attributes(*decoded.batch);
    leaf->attributes(decoded.block, *decoded.batch);
    leaf->shape(decoded.block, batch_->rest, 1, *decoded.batch);
    return decoded;
  }
  float longest(size_t s) const {
    float max = 0;
    for (int p = 1; p < kPoints; ++p)
      max = std::max(max, (batch_->offset(p, s) - batch_->offset(p - 1, s)).length());
    return max;
  }
  float widest(size_t s) const {
    float max = 0;
    for (const auto& point : batch_->points) max = std::max(max, point.radius[s]);
    return max;
  }

  std::unique_ptr<StrandBatch> batch_ = std::make_unique<StrandBatch>();
};

TEST_F(StrandCodesTest, ComeBackAsNearAsStated) {
  for (const bool one_profile : {false, true}) {
    const Decoded decoded = through_codes({one_profile});
    const StrandBatch& now = *decoded.batch;
    ASSERT_FALSE(decoded.block.plain);
    for (size_t s = 0; s < batch_->count; ++s) {
      EXPECT_NEAR(now.clump[s], batch_->clump[s], 1.0f / 65536);
      for (int p = 0; p < kPoints; ++p) {
        const auto i = static_cast<size_t>(p);
        EXPECT_LE((now.offset(p, s) - batch_->offset(p, s)).length(), 0.868f * longest(s) / 32766 + 2e-6f);
        EXPECT_NEAR(now.points[i].radius[s], batch_->points[i].radius[s],
                    widest(s) * (0x1p-11f + (one_profile ? 1 / 131000.0f : 1 / 509.0f)));
        V3f brightest(0);
        for (const VectorRow& row : batch_->colors) {
          for (int c = 0; c < 3; ++c) brightest[c] = std::max(brightest[c], std::fabs(vector_at(row, s)[c]));
        }
        const float max = std::max({brightest.x, brightest.y, brightest.z});
        for (int c = 0; c < 3; ++c)
          EXPECT_NEAR(vector_at(now.colors[i], s)[c], vector_at(batch_->colors[i], s)[c], 0.0015f * max);
      }
    }
  }
}

// One strand that does not fit must not change those beside it.
TEST_F(StrandCodesTest, OfStrandsBesideOneThatDoesNotFitAreTheSame) {
  const std::unique_ptr<StrandBatch> before = std::move(through_codes({}).batch);
  struct Misfit {
    const char* what;
    std::function<void(StrandBatch&)> make;
  };
  const std::vector<Misfit> misfits{
      {"thin",
       [](StrandBatch& b) {
         for (auto& p : b.points) p.radius[17] = 1e-7f;
       }},
      {"long", [](StrandBatch& b) { b.set_offset(3, 17, V3f(1e30f, 0, 0)); }},
      {"no number", [](StrandBatch& b) { b.set_offset(2, 17, V3f(NAN, 0, 0)); }},
      {"wide", [](StrandBatch& b) { b.points[2].radius[17] = 1e9f; }},
      {"bright", [](StrandBatch& b) { b.colors[1][2][17] = 1e12f; }},
      {"no colour", [](StrandBatch& b) { b.colors[1][2][17] = NAN; }},
  };
  const StrandBatch whole = *batch_;
  for (const Misfit& misfit : misfits) {
    *batch_ = whole;
    misfit.make(*batch_);
    const Decoded decoded = through_codes({});
    EXPECT_TRUE(decoded.block.plain) << misfit.what;
    for (size_t s = 0; s < batch_->count; ++s) {
      if (s == 17) continue;
      for (size_t p = 0; p < kPoints; ++p) {
        const auto point = static_cast<int>(p);
        ASSERT_EQ(decoded.batch->offset(point, s), before->offset(point, s)) << misfit.what;
        ASSERT_EQ(decoded.batch->points[p].radius[s], before->points[p].radius[s]) << misfit.what;
        ASSERT_EQ(vector_at(decoded.batch->colors[p], s), vector_at(before->colors[p], s)) << misfit.what;
      }
    }
    EXPECT_EQ(decoded.batch->points[4].radius[17], batch_->points[4].radius[17]) << misfit.what;
  }
}

}  // namespace
}  // namespace pelage
