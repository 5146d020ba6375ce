// SPDX-License-Identifier: Apache-2.0
#include "groom/sim/rod.h"

#include <numbers>

#include <gtest/gtest.h>

namespace pelage {
namespace rod_test {

constexpr double kPi = std::numbers::pi;
const V3d kGravity(0, -9.81, 0);

std::vector<V3d> straight(double length, size_t segments, const V3d& along = V3d(0, 0, 1)) {
  std::vector<V3d> points;
  for (size_t i = 0; i <= segments; ++i)
    points.push_back(along * (length * static_cast<double>(i) / static_cast<double>(segments)));
  return points;
}

RodRoot clamp_along(const V3d& along) { return {V3d(0), smallest_turn(V3d(0, 0, 1), along)}; }

/// Steps a rod whose root stays. Calls visit(state, time) after each step.
template <class Visit>
void run(const Rod& rod, const V3d& gravity, double seconds, int steps, RodState& state, const Visit& visit) {
  Rod::Workspace work;
  RodForces forces;
  forces.gravity = gravity;
  for (int i = 0; i < steps; ++i) {
    ASSERT_TRUE(rod.step(state.root, forces, seconds, 3, state, work));
    visit(state, seconds * (i + 1));
  }
}
void run(const Rod& rod, const V3d& gravity, double seconds, int steps, RodState& state) {
  run(rod, gravity, seconds, steps, state, [](const RodState&, double) {});
}

/// Mean time between two passages of value(state) through 0 in the same direction.
template <class Value>
double period(const Rod& rod, const V3d& gravity, double seconds, int steps, RodState& state,
              const Value& value) {
  double before = value(state), first = 0, last = 0;
  int count = 0;
  run(rod, gravity, seconds, steps, state, [&](const RodState& now, double time) {
    const double after = value(now);
    if (before < 0 && after >= 0) {
      last = time - seconds * after / (after - before);
      if (count++ == 0) first = last;
    }
    before = after;
  });
  EXPECT_GE(count, 3);
  return (last - first) / (count - 1);
}

/// Deflection of the tip of a clamped rod of length 1 under its weight, by shooting: EI t'' = -w (1 - s) cos
/// t with t(0) = 0, t'(1) = 0, where t is the angle below the horizontal and `load` is w / EI.
double elastica(double load) {
  double low = 0, high = load, y = 0;
  for (int k = 0; k < 60; ++k) {
    const double slope = (low + high) / 2;
    constexpr int kSteps = 2000;
    double t = 0, rate = slope;
    y = 0;
    for (int i = 0; i < kSteps; ++i) {  // midpoint rule
      const double h = 1.0 / kSteps, s = i * h;
      const double t_half = t + rate * h / 2, rate_half = rate - load * (1 - s) * std::cos(t) * h / 2;
      y += std::sin(t_half) * h;
      t += rate_half * h;
      rate -= load * (1 - s - h / 2) * std::cos(t_half) * h;
    }
    (rate > 0 ? high : low) = slope;
  }
  return y;
}

/// Weight per length over bending stiffness.
double load_of(const RodMaterial& m) {
  return m.density * 9.81 * 4 / (m.youngs_modulus * m.radius * m.radius);
}

RodMaterial loaded(double load, double length) {
  RodMaterial m;
  m.youngs_modulus = 1;
  m.youngs_modulus = load_of(m) / load * (length * length * length);
  return m;
}

// The error of a cantilever of n segments is O(1 / n^2); 2 % are demanded.
TEST(Rod, CantileversBendLikeTheElastica) {
  for (const double load : {0.1, 2.0, 10.0}) {
    const RodMaterial m = loaded(load, 0.02);
    const Rod rod(straight(0.02, 15, V3d(1, 0, 0)), m, clamp_along(V3d(1, 0, 0)));
    RodState state = rod.rest();
    run(rod, kGravity, 0.05, 400, state);
    EXPECT_NEAR(-state.positions.back().y / 0.02, elastica(load), 0.02 * elastica(load)) << load;
  }
  // Small deflections of a single segment: w L^4 / (8 EI).
  const RodMaterial m = loaded(0.1, 0.02);
  const Rod rod(straight(0.02, 1, V3d(1, 0, 0)), m, clamp_along(V3d(1, 0, 0)));
  RodState state = rod.rest();
  run(rod, kGravity, 0.05, 400, state);
  EXPECT_NEAR(-state.positions.back().y / 0.02, 0.1 / 8, 0.02 * 0.1 / 8);
}

// A hanging rope: the lowest frequency is j0 / 2 sqrt(g / L), with the first zero j0 = 2.404826 of J0.
TEST(Rod, RopesSwingWithTheirPeriod) {
  RodMaterial m;
  m.youngs_modulus = 1e9;
  m.radius = 1e-5;
  const V3d down(0, -1, 0);
  const double expected = 2 * kPi / (2.404826 / 2 * std::sqrt(9.81));
  std::vector<V3d> points = straight(1, 15, down);
  const Rod rod(points, m, clamp_along(down));
  RodState state = rod.rest();
  for (size_t i = 0; i < points.size(); ++i) {  // velocity of the mode, J0(j0 sqrt(height)): nearly linear
    const double z = 2.404826 * std::sqrt(1 - static_cast<double>(i) / 15);
    state.velocities[i] = V3d(-0.1 * std::cyl_bessel_j(0, z), 0, 0);
  }
  const double found = period(rod, kGravity, expected / 400, 1500, state,
                              [](const RodState& s) { return s.positions.back().x; });
  EXPECT_NEAR(found, expected, 0.01 * expected);
}

// Lowest frequency of a cantilever: 1.875104^2 sqrt(EI / (rho A L^4)).
TEST(Rod, CantileversVibrateWithTheirFrequency) {
  RodMaterial m;
  const double length = 0.05;
  const double expected =
      2 * kPi /
      (1.875104 * 1.875104 *
       std::sqrt(m.youngs_modulus * m.radius * m.radius / 4 / m.density / std::pow(length, 4)));
  const Rod rod(straight(length, 15), m, clamp_along(V3d(0, 0, 1)));
  RodState state = rod.rest();
  run(rod, V3d(0.05, 0, 0), 1, 100, state);  // a small deflection at rest
  const double found = period(rod, V3d(0), expected / 400, 1500, state,
                              [](const RodState& s) { return s.positions.back().x; });
  EXPECT_NEAR(found, expected, 0.03 * expected);
}

// A rod of constant curvature k and torsion t is a helix of radius k / (k^2 + t^2) that turns by
// sqrt(k^2 + t^2) per length and rises by t / sqrt(k^2 + t^2) per length.
TEST(Rod, StraightRodsTwistIntoTheHelixOfTheirRestShape) {
  constexpr size_t kSegments = 40;
  const double length = 0.04, k = 200, t = 120, turn = std::sqrt(k * k + t * t);
  Rod rod(straight(length, kSegments), {}, {});
  rod.set_curvature(V3d(k, 0, t));
  RodState state = rod.rest();
  run(rod, V3d(0), 0.01, 300, state);
  const double angle = turn * length, radius = k / (turn * turn), rise = t / turn * length;
  const double chord = std::hypot(2 * radius * std::sin(angle / 2), rise);
  EXPECT_NEAR((state.positions.back() - state.positions.front()).length(), chord, 0.01 * chord);
  EXPECT_LT(rod.energy(state, V3d(0)), 1e-6 * rod.energy(rod.rest(), V3d(0)));
}

TEST(Rod, EnergyNeverGrowsWithoutForces) {
  for (const double stiffness : {1e5, 1e7, 1e9}) {
    RodMaterial m;
    m.youngs_modulus = stiffness;
    std::vector<V3d> points = straight(0.03, 15);
    const Rod rod(points, m, clamp_along(V3d(0, 0, 1)));
    RodState state = rod.rest();
    for (size_t i = 1; i < points.size(); ++i)
      state.velocities[i] = V3d(0.2 * std::sin(static_cast<double>(i)), 0.02 * static_cast<double>(i), 0);
    double before = rod.energy(state, V3d(0));
    run(rod, V3d(0), 1.0 / 480, 500, state, [&](const RodState& now, double) {
      const double after = rod.energy(now, V3d(0));
      EXPECT_LE(after, before * (1 + 1e-9) + 1e-20);
      before = after;
    });
  }
}

TEST(Rod, FreeFlightKeepsMomentum) {
  RodMaterial m;
  m.youngs_modulus = 1e8;
  const Rod rod(straight(0.03, 15), m, {});
  RodState state = rod.rest();
  for (size_t i = 0; i < state.velocities.size(); ++i)
    state.velocities[i] = V3d(1, 0.01 * static_cast<double>(i), 0.05 * std::sin(static_cast<double>(i)));
  const V3d momentum = rod.momentum(state), spin = rod.angular_momentum(state);
  run(rod, V3d(0), 1e-4, 500, state);
  EXPECT_LT((rod.momentum(state) - momentum).length(), 1e-9 * momentum.length());
  // Implicit Euler damps rotation in proportion to the step.
  EXPECT_LT((rod.angular_momentum(state) - spin).length(), 0.01 * spin.length());
}

// Softer rods would balance too, but so unstably that rounding tips them over.
TEST(Rod, BalancedRodsHangAsTheyWereMade) {
  for (const double stiffness : {2e8, 4e9}) {
    RodMaterial m;
    m.youngs_modulus = stiffness;
    std::vector<V3d> points;
    for (int i = 0; i < 16; ++i) {
      const double s = i / 15.0;
      points.push_back(V3d(0.01 * std::sin(2 * s), 0.004 * s * s, 0.01 * s));
    }
    Rod rod(points, m, clamp_along(V3d(0.6, 0, 0.8)));
    rod.balance(kGravity);
    RodState state = rod.rest();
    run(rod, kGravity, 1.0 / 96, 200, state);
    for (size_t i = 0; i < points.size(); ++i)
      EXPECT_LT((state.positions[i] - points[i]).length(), m.radius / 2) << i;
  }
}

// Any finite parameter: the step has a finite result, or says that it has none.
TEST(Rod, HostileParametersGiveNoInfinities) {
  for (const double stiffness : {0.0, 1e-6, 1e12, 1e30}) {
    for (const double radius : {1e-9, 1e-4, 1.0}) {
      for (const size_t segments : {size_t(1), size_t(15)}) {
        RodMaterial m;
        m.youngs_modulus = stiffness;
        m.radius = radius;
        m.drag = 1e-4;
        Rod rod(straight(0.02, segments), m, clamp_along(V3d(1, 0, 0)));
        rod.balance(kGravity);
        RodState state = rod.rest();
        Rod::Workspace work;
        for (int i = 0; i < 50; ++i) {
          RodRoot root = clamp_along(i % 2 ? V3d(0, 0, 1) : V3d(-1, 0, 0));
          root.position = V3d(i == 20 ? 100 : 0, 0.01 * i, 0);
          RodForces forces;
          forces.gravity = kGravity;
          if (!rod.step(root, forces, 1.0 / 96, 2, state, work)) break;
          for (const V3d& p : state.positions) ASSERT_TRUE(std::isfinite(p.length()));
          ASSERT_EQ(state.positions.front(), root.position);
        }
      }
    }
  }
}

}  // namespace rod_test
}  // namespace pelage
