// SPDX-License-Identifier: Apache-2.0
#include "groom/sim/rod_pack.h"

#include <cmath>

#include <gtest/gtest.h>

#include "base/hash.h"
#include "tests/support/effort.h"

namespace pelage {
namespace rod_pack_test {

constexpr size_t kLanes = RodPack::kLanes;

double random(uint64_t i, uint64_t use) { return signed_float(hash64(i, use)); }

/// Combed rods of about 1.5 cm that are shaken in wind, with a hard plane and a soft one below them.
struct ShakenRods {
  explicit ShakenRods(size_t segments) {
    step.gravity = V3d(0, -9.81, 0);
    step.seconds = 1 / 96.0;
    step.has_air = true;
    step.planes = 2;
    step.softness = {0, 4000, 0};
    RodMaterial material;
    material.radius = 3e-5;
    material.drag = 1e-4;
    material.damping = 0.004;
    material.friction = 0.3;
    for (uint64_t g = 0; g < kLanes; ++g) {
      std::vector<V3d> points;
      for (size_t i = 0; i <= segments; ++i) {
        const double s = static_cast<double>(i) / static_cast<double>(segments);
        points.push_back(
            V3d(0.015 * s * (1 + 0.1 * random(g, 1)), 0.002 * random(g, 2) * s, 0.008 * s * (1.3 - s)));
      }
      rods.emplace_back(points, material, RodRoot{V3d(0), Imath::Quatd()});
      rods.back().balance(step.gravity);
      states.push_back(rods.back().rest());
    }
  }
  static RodRoot root(uint64_t time) {
    return {V3d(random(time, 3), random(time, 4), random(time, 5)) * 0.004,
            Imath::Quatd(1, V3d(random(time, 6), random(time, 7), random(time, 8)) * 0.2).normalize()};
  }
  static V3d air(size_t lane, uint64_t time) { return {5 + 3 * random(lane + kLanes * time, 9), 0, 1}; }
  static CarriedPlane plane(size_t node, size_t which) {
    if (node == 0 || (which == 0 && node % 3 == 0)) return {};
    return {V3d(0, 0, which == 0 ? 5e-5 : 3e-3), V3d(0.1, 0, 1).normalized()};
  }

  /// The rod of each lane of `of` moves into the same lane of the pack.
  void fill(RodPack& pack, uint64_t time, const std::vector<size_t>& of) const {
    pack.reset(rods[0].segment_count());
    for (size_t lane = 0; lane < kLanes; ++lane) {
      const size_t g = of[lane];
      pack.set_rod(lane, rods[g], states[g]);
      pack.set_root(lane, root(time));
      for (size_t i = 0; i < states[g].positions.size(); ++i) {
        pack.set_air(lane, i, air(g, time));
        for (size_t k = 0; k < step.planes; ++k) pack.set_plane(lane, i, k, plane(i, k));
      }
    }
  }
  /// Steps a rod by itself.
  bool step_alone(size_t g, uint64_t time, RodState& state) const {
    const std::vector<V3d> velocities(state.positions.size(), air(g, time));
    std::vector<RodContact> contacts;
    for (size_t i = 0; i < state.positions.size(); ++i) {
      for (size_t k = 0; k < step.planes; ++k) {
        contacts.push_back(plane(i, k).contact(state.root, root(time)));
        contacts.back().softness = step.softness[k];
      }
    }
    Rod::Workspace work;
    return rods[g].step(root(time), {step.gravity, velocities, contacts}, step.seconds, step.iterations,
                        state, work);
  }

  std::vector<Rod> rods;
  std::vector<RodState> states;
  RodPack::Step step;
};

// Both add the same numbers in another order. Rounding of 1e-16 grows by the condition of the matrix, up to
// 1e5.
TEST(RodPack, StepsLikeEachRodByItself) {
  for (const size_t segments : {size_t(1), size_t(2), size_t(15)}) {
    ShakenRods shaken(segments);
    RodPack pack;
    const int steps = repetitions(100);
    for (int time = 1; time <= steps; ++time) {
      const auto t = static_cast<uint64_t>(time);
      shaken.fill(pack, t, {0, 1, 2, 3, 4, 5, 6, 7});
      pack.step(shaken.step);
      for (size_t g = 0; g < kLanes; ++g) {
        RodState expected = shaken.states[g], found = expected;
        ASSERT_TRUE(shaken.step_alone(g, t, expected));
        ASSERT_TRUE(pack.is_finite(g));
        pack.get_state(g, found);
        for (size_t i = 0; i <= segments; ++i) {
          ASSERT_LT((found.positions[i] - expected.positions[i]).length(), 1e-8 * 0.015);
          ASSERT_LT((found.velocities[i] - expected.velocities[i]).length(), 1e-8 * 0.015 * 96);
        }
        for (size_t i = 0; i < segments; ++i) {
          ASSERT_LT((found.frames[i].v - expected.frames[i].v).length(), 1e-8);
        }
        EXPECT_EQ(found.root.position, ShakenRods::root(t).position);
        shaken.states[g] = found;
      }
    }
  }
}

TEST(RodPack, NoLaneDependsOnTheOthers) {
  ShakenRods shaken(9);
  RodPack together, shuffled;
  const std::vector<size_t> order{5, 2, 7, 0, 0, 6, 1, 3};
  for (uint64_t time = 1; time <= 20; ++time) {
    shaken.fill(together, time, {0, 1, 2, 3, 4, 5, 6, 7});
    together.step(shaken.step);
    shaken.fill(shuffled, time, order);
    // A rod without a finite step.
    RodState broken = shaken.states[0];
    broken.velocities[4].x = NAN;
    shuffled.set_rod(4, shaken.rods[0], broken);
    shuffled.set_root(4, ShakenRods::root(time));
    shuffled.step(shaken.step);
    EXPECT_FALSE(shuffled.is_finite(4));
    for (size_t lane = 0; lane < kLanes; ++lane) {
      if (lane == 4) continue;
      RodState a = shaken.states[0], b = a;
      together.get_state(order[lane], a);
      shuffled.get_state(lane, b);
      EXPECT_TRUE(shuffled.is_finite(lane));
      EXPECT_EQ(a.positions, b.positions);
      EXPECT_EQ(a.velocities, b.velocities);
    }
    for (size_t g = 0; g < kLanes; ++g) together.get_state(g, shaken.states[g]);
  }
}

}  // namespace rod_pack_test
}  // namespace pelage
