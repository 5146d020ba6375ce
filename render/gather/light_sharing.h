// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <vector>

#include "base/vector.h"
#include "render/fibre/fibre_value.h"

namespace pelage {

/// For each knot and each light, estimates the fraction of the light that reaches the points of the knot. A
/// knot is a position on a strand or skin near which visible points share light. A zone, which contains many
/// knots, is one of eight depth ranges of a coat, or a whole skin. See knot_keys.h for both.
///
/// The estimate uses shadow rays from some of the points. Each ray has a weight: the unoccluded light that
/// the ray represents, including the light of points without a ray. On average, the sum of the weights equals
/// the whole unoccluded light, because SystematicChoice chooses the rays. Weights have a number for each lobe
/// group and colour, and so have fractions. For one knot, light, lobe group and colour, let
///   U        be the exact unoccluded light: the sum over all points of the knot,
///   seen     be the sum of the weights of the rays,
///   arrived  be the sum of (weight * fraction that the ray transmits) over the rays,
///   p        be a guess of the fraction.
/// Then the estimated fraction is p + (arrived - p * seen) / U.
///
/// This estimate is unbiased for every p that does not depend on the rays of this knot. The random choice of
/// rays changes `arrived` and `p * seen` in the same way, so most of the noise of this choice cancels. For p,
/// the class uses arrived / seen of all other knots of the same zone, by luminance over all lobe groups.
class LightSharing {
 public:
  /// Starts a tile. `guess`: whether p is the mean over the other knots of the zone; otherwise, p = 0.
  void begin(size_t lights, bool guess);

  /// Adds the unoccluded light of one point, by lobe group, to U of its knot. Knots have the indices 0, 1, 2
  /// ..., and so have zones. They may be added in any order.
  void add_unoccluded(uint32_t knot, size_t light, const Rgb* lobes);
  /// Adds a shadow ray of a knot in `zone`. Its weight is `factor` times the light of each of the `lobes`.
  /// `through`: fraction that the ray transmits.
  void add_ray(uint32_t knot, uint32_t zone, size_t light, const Rgb* lobes, float factor, float through);
  /// Estimates the fraction of a light that arrives in a zone, from the rays that were added so far. Callers
  /// use the result to choose further rays. The result is 1 without rays. It is at least kMinChance, so that
  /// every light gets some rays.
  float chance(uint32_t zone, size_t light) const;
  /// Computes the fraction of each knot and light. Call after all rays were added.
  void finish(const std::vector<uint32_t>& zone_of_knot);
  /// Returns the max memory per knot, in bytes. The factor 2 is for vectors that double their size.
  static size_t bytes_per_knot(size_t lights) { return 2 * lights * sizeof(Knot); }
  /// Returns the result of finish() for a knot and a light.
  const Rgb& fraction(uint32_t knot, size_t light, int group) const {
    return knots_[knot * lights_ + light].arrived[group];
  }

 private:
  static constexpr float kMinChance = 0.02f;
  struct Zone {
    double seen = 0, arrived = 0;  // sums over the knots of the zone
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
