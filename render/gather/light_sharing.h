// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <vector>

#include "base/vector.h"

namespace pelage {

/// Fraction of the light of each source that reaches the points of each knot, from shadow rays of some of the
/// points.
///
/// Shadow rays are an unbiased sample of the unoccluded light (SystematicChoice). With `seen` the sum over
/// the rays of a knot of the unoccluded light that each stands for, `arrived` what is left of it in front of
/// blockers, U the exact unoccluded light of the knot, and p a guess, the fraction is
///   p + (arrived - p * seen) / U.
/// On average it is right for any p that does not depend on these rays: p * seen varies as arrived does, so
/// that the noise of the choice cancels. p is the mean over the other knots of the zone.
class LightSharing {
 public:
  /// `guess`: whether other knots are asked; otherwise p = 0.
  void begin(size_t lights, bool guess);

  /// Knots and zones are numbered from 0, in any order.
  void add_unoccluded(uint32_t knot, size_t light, float luminance);
  /// A shadow ray that stands for `luminance`, of which the fraction `through` arrives.
  void add_ray(uint32_t knot, uint32_t zone, size_t light, float luminance, float through);
  /// Estimate of the fraction of a light that arrives in a zone, from the rays so far: for the choice of
  /// further rays. At least kMinChance, so that no light is given up.
  float chance(uint32_t zone, size_t light) const;
  /// Computes the fractions, once everything is added.
  void finish(const std::vector<uint32_t>& zone_of_knot);
  static size_t bytes_per_knot(size_t lights) { return 2 * lights * sizeof(Knot); }  // vectors grow twofold
  float fraction(uint32_t knot, size_t light) const { return knots_[knot * lights_ + light].fraction; }

 private:
  static constexpr float kMinChance = 0.02f;
  struct Zone {
    double seen = 0, arrived = 0;
    uint32_t rays = 0;
  };
  struct Knot {
    float unoccluded = 0, seen = 0, arrived = 0, fraction = 0;
  };

  size_t lights_ = 0;
  bool guess_ = true;
  std::vector<Knot> knots_;  // by knot and light
  std::vector<Zone> zones_;  // by zone and light
};

}  // namespace pelage
