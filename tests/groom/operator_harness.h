// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <algorithm>
#include <cmath>
#include <memory>
#include <numbers>

#include <gtest/gtest.h>

#include "base/hash.h"
#include "base/job.h"
#include "groom/follicles/follicles.h"
#include "groom/operators/operator.h"
#include "groom/operators/operator_stack.h"
#include "groom/strands/rotation.h"
#include "groom/strands/strand_batch.h"
#include "image/texture_library.h"
#include "tests/groom/shapes.h"

namespace pelage {

/// Random numbers of a test, in order.
class TestRandom {
 public:
  explicit TestRandom(uint64_t seed) : seed_(seed) {}
  float unit() { return unit_float(hash64(seed_, next_++)); }
  float between(float low, float high) { return low + (high - low) * unit(); }
  V3f direction() {
    const float z = between(-1, 1), angle = between(0, 2 * std::numbers::pi_v<float>),
                r = std::sqrt(1 - z * z);
    return {r * std::cos(angle), r * std::sin(angle), z};
  }
  /// A direction at most `angle` away from the unit vector `axis`, uniform by solid angle.
  V3f direction_near(const V3f& axis, float angle) {
    const float c = between(std::cos(angle), 1), s = std::sqrt(std::max(0.0f, 1 - c * c));
    const float turn = between(0, 2 * std::numbers::pi_v<float>);
    const V3f a = any_perpendicular(axis), b = axis.cross(a);
    return axis * c + (a * std::cos(turn) + b * std::sin(turn)) * s;
  }

 private:
  uint64_t seed_;
  uint64_t next_ = 0;
};

/// Operators on a ball of radius about 1, with random strands to try them on.
class OperatorTest : public testing::Test {
 protected:
  OperatorTest() : rest_(shapes::surface_of(shapes::ball_cage(1.2f))), workers_(2) {
    FollicleOptions options;
    options.count = 2048;
    options.leaf_strands = static_cast<int>(kBlockStrands);  // so that a batch is compact
    follicles_ = FollicleTree::build(*rest_, options, job_);
  }

  PrepareContext context(int points = 8) {
    return {rest_.get(), textures_, job_, {}, 99, points, {}, "groom 'coat'"};
  }

  template <class Op>
  Op prepared(typename Op::Params params, int points = 8) {
    Op op(std::move(params));
    op.prepare(context(points));
    return op;
  }

  /// A batch of straight strands of unit length on the follicles from `first` on.
  std::unique_ptr<StrandBatch> straight(size_t first = 0, int points = 8,
                                        size_t count = kBlockStrands) const {
    auto batch = std::make_unique<StrandBatch>();
    batch->count = std::min(count, follicles_.size() - first);
    place_on_rest(*batch, *rest_, follicles_, first);
    start_strands(*batch, points);
    return batch;
  }

  /// Random strands that `reach` bounds: every other one straight and as long as may be, the rest wandering.
  std::unique_ptr<StrandBatch> random_strands(const StrandReach& reach, size_t first, uint64_t seed) const {
    auto batch = straight(first, reach.segments + 1);
    TestRandom random(seed);
    const auto segments = static_cast<float>(reach.segments);
    for (size_t s = 0; s < batch->count; ++s) {
      const V3f normal = vector_at(batch->rest.normal, s);
      const bool is_straight = s % 2 == 0;
      const V3f direction = random.direction_near(normal, reach.lean);
      const float length = reach.length * (is_straight ? 0.99999f : random.unit());
      V3f at(0);
      for (int p = 1; p <= reach.segments; ++p) {
        at += (is_straight ? direction : random.direction_near(normal, reach.lean)) * (length / segments);
        batch->set_offset(p, s, at);
      }
      for (int p = 0; p <= reach.segments; ++p) {
        batch->points[static_cast<size_t>(p)].radius[s] = reach.radius * random.unit();
      }
    }
    return batch;
  }

  /// What the operator says of its result holds for random strands, and some point of them is farther from
  /// its root than `min` times the max distance that it states.
  void check_bounds(const Operator& op, const StrandReach& before, float min = 1.0f / 1.5f) const {
    const StrandReach after = op.reach_after(before);
    StrandReach seen{0, 0, 0, 0, before.segments};
    for (uint64_t round = 0; round < 24; ++round) {
      auto batch = random_strands(before, (round % 7) * kBlockStrands, round);
      op.apply(*batch);
      for (size_t s = 0; s < batch->count; ++s) {
        float length = 0;
        for (int p = 0; p < batch->point_count(); ++p) {
          const V3f point = batch->offset(p, s);
          ASSERT_TRUE(std::isfinite(point.x) && std::isfinite(point.y) && std::isfinite(point.z));
          seen.distance = std::max(seen.distance, point.length());
          seen.radius = std::max(seen.radius, batch->points[static_cast<size_t>(p)].radius[s]);
          if (p == 0) continue;
          const V3f step = point - batch->offset(p - 1, s);
          length += step.length();
          if (step.length() > 1e-5f) {
            const float cosine =
                std::clamp(normalised_or(step, V3f(0)).dot(vector_at(batch->rest.normal, s)), -1.0f, 1.0f);
            seen.lean = std::max(seen.lean, std::acos(cosine));
          }
        }
        seen.length = std::max(seen.length, length);
        ASSERT_EQ(batch->offset(0, s), V3f(0)) << "the root moved";
      }
    }
    const float room = 1.0f + 1e-4f;
    EXPECT_LE(seen.length, after.length * room);
    EXPECT_LE(seen.distance, after.distance * room);
    EXPECT_GT(seen.distance, after.distance * min) << "the bound is loose";
    EXPECT_LE(seen.radius, after.radius * room);
    EXPECT_LE(seen.lean, after.lean + 2e-3f);
  }

  static float length_of(const StrandBatch& batch, size_t s) {
    float length = 0;
    for (int p = 1; p < batch.point_count(); ++p)
      length += (batch.offset(p, s) - batch.offset(p - 1, s)).length();
    return length;
  }

  std::shared_ptr<const LimitSurface> rest_;
  MemoryLedger ledger_;
  TextureLibrary textures_{ledger_};
  Workers workers_;
  NoProgress progress_;
  Job job_{workers_, ledger_, progress_};
  FollicleTree follicles_;
};

}  // namespace pelage
