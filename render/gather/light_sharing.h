// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <vector>

#include "base/vector.h"
#include "render/fibre/fibre_value.h"

namespace pelage {

/// Fraction of the light of each source that reaches the points of each knot, estimated from shadow rays of
/// some of the points.
///
/// Each shadow ray has a weight: the unoccluded light that it represents, by lobe group and colour. The rays
/// are chosen so that the expected sum of their weights is the unoccluded light (SystematicChoice). For one
/// light, knot, lobe group and colour, `seen` is the sum of the weights of the rays, `arrived` is the sum of
/// the weights times the transmitted fractions, U is the exact unoccluded light, and p is a guess of the
/// result. The estimated fraction is
///   p + (arrived - p * seen) / U.
/// This estimate is unbiased for any p that does not depend on these rays. The random choice of rays changes
/// `p * seen` and `arrived` in the same way, so most of its noise cancels. p is the mean over the other knots
/// of the same zone, by luminance (KnotKeys says what a zone is).
class LightSharing {
 public:
  /// `guess`: whether p is the mean over other knots; otherwise p = 0.
  void begin(size_t lights, bool guess);

  /// Adds to the exact unoccluded light of a knot. Knots and zones are numbered from 0, in any order.
  /// `lobes`: light by lobe group.
  void add_unoccluded(uint32_t knot, size_t light, const Rgb* lobes);
  /// Adds a shadow ray that transmits the fraction `through`. Its weight is `factor` times the light of each
  /// of the `lobes`.
  void add_ray(uint32_t knot, uint32_t zone, size_t light, const Rgb* lobes, float factor, float through);
  /// Estimate of the fraction of a light that arrives in a zone, from the rays so far. It controls the choice
  /// of further rays. At least kMinChance, so that every light keeps some rays.
  float chance(uint32_t zone, size_t light) const;
  /// Computes the fractions. Call after all rays were added.
  void finish(const std::vector<uint32_t>& zone_of_knot);
  static size_t bytes_per_knot(size_t lights) { return 2 * lights * sizeof(Knot); }  // vectors grow twofold
  const Rgb& fraction(uint32_t knot, size_t light, int group) const {
    return knots_[knot * lights_ + light].arrived[group];
  }

 private:
  static constexpr float kMinChance = 0.02f;
  struct Zone {
    double seen = 0, arrived = 0;
    uint32_t rays = 0;
  };
  struct Knot {
    Rgb unoccluded[kLobeGroups] = {Rgb(0), Rgb(0), Rgb(0)};
    Rgb seen[kLobeGroups] = {Rgb(0), Rgb(0), Rgb(0)};
    Rgb arrived[kLobeGroups] = {Rgb(0), Rgb(0), Rgb(0)};  ///< finish() replaces it by the fraction
  };

  static float guess_of_others(const Zone& zone, const Knot& own);

  size_t lights_ = 0;
  bool guess_ = true;
  std::vector<Knot> knots_;  // by knot and light
  std::vector<Zone> zones_;  // by zone and light
};

}  // namespace pelage
