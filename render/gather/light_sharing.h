// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <vector>

#include "base/vector.h"
#include "render/fibre/fibre_value.h"
#include "render/gather/arrival_guess.h"
#include "render/gather/depth_profile.h"

namespace pelage {

/// For each gather point (see gather_point_keys.h) and each light, estimates the fraction of the light that
/// reaches the visible points assigned to the gather point.
///
/// The estimate uses shadow rays from some of these visible points. Each ray has a weight: the unoccluded
/// light that the ray represents, including the light of points without a ray. On average, the sum of the
/// weights equals the whole unoccluded light, because SystematicChoice chooses the rays. Weights and
/// fractions have a number for each lobe group and colour. For one gather point, light, lobe group and
/// colour, let
///   U  be the exact unoccluded light: the sum over all candidates of all points (possible targets of rays),
///   p  be a guess of the fraction that arrives from a candidate (ArrivalGuess).
/// Then the estimated fraction is
///   (sum over candidates of (light * p) + sum over rays of (weight * (fraction that the ray transmits - p)))
///   / U.
///
/// This estimate is unbiased for every p that does not depend on the choice of the rays that it is used for.
/// The random choice of rays changes both parts of the second sum in the same way, so most of the noise of
/// this choice cancels.
///
/// Unoccluded light may be multiplied by a factor of its visible point, before it is added to U and when it
/// is multiplied by the fraction. The sum of these products over the points of a gather point does not
/// change, but their distribution does. DepthProfile gives these factors.
class LightSharing {
 public:
  /// Starts a tile. `groups`: count of groups of lights that the guess tells apart.
  void begin(size_t lights, size_t groups);

  // Gather points have the indices 0, 1, 2 ... They may be added in any order.
  /// Adds unoccluded light of one visible point, by lobe group, to U of its gather point.
  void add_unoccluded(uint32_t gather_point, size_t light, const Rgb* lobes);
  /// Adds light, by lobe group, times `factor` to the numerator of the fraction.
  void add_arriving(uint32_t gather_point, size_t light, const Rgb* lobes, float factor);
  /// Computes the fraction of each gather point and light. Call after all light was added.
  void finish(size_t gather_points);
  /// Returns what rays have found so far in this tile.
  ArrivalGuess& guess() { return guess_; }
  DepthProfile& profile() { return profile_; }
  /// Returns the max memory per gather point, in bytes. The factor 2 is for vectors that double their size.
  static size_t bytes_per_gather_point(size_t lights) { return 2 * lights * sizeof(GatherPoint); }
  /// Returns the result of finish() for a gather point and a light.
  const Rgb& fraction(uint32_t gather_point, size_t light, int group) const {
    return gather_points_[gather_point * lights_ + light].arriving[group];
  }

 private:
  struct GatherPoint {
    Rgb unoccluded[kLobeGroups] = {Rgb(0), Rgb(0), Rgb(0)};
    Rgb arriving[kLobeGroups] = {Rgb(0), Rgb(0), Rgb(0)};  ///< finish() replaces it by the fraction
  };
  GatherPoint& at(uint32_t gather_point, size_t light);

  size_t lights_ = 0;
  ArrivalGuess guess_;
  DepthProfile profile_;
  std::vector<GatherPoint> gather_points_;  // by gather point and light
};

}  // namespace pelage
