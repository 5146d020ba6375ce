// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "base/vector.h"
#include "render/fibre/fibre_value.h"
#include "render/gather/depth_profile.h"

namespace pelage {

/// For each gather point (see gather_point_keys.h), light and lobe group, estimates the mean radiance of the
/// indirect light that arrives at the visible points assigned to the gather point. The indirect light that a
/// visible point scatters to the camera is this radiance times the weight of the point, rho / pdf.
///
/// The estimate uses paths from some of these points. For one gather point, light, lobe group and colour, let
///   W        be the sum of the weights of all points,
///   seen     be the sum of (weight * count of points that the path represents) over the paths,
///   arrived  be the same sum, each term times the radiance of the path,
///   p        be a guess of the radiance.
/// Then the estimated radiance is p + (arrived - p * seen) / W. It is unbiased for every p that does not
/// depend on the paths of this gather point. For p, the class uses arrived / seen of all other gather points
/// of the same zone (one of eight depth ranges of a coat, or a whole skin).
///
/// Radiances may be relative to a factor of each visible point, by which the weights of the point are
/// multiplied. DepthProfile gives these factors.
class PathSharing {
 public:
  /// Starts a tile. `guess`: whether p is the mean over the other gather points of the zone; otherwise, p =
  /// 0.
  void begin(size_t gather_points, uint32_t zones, size_t lights, bool guess);

  DepthProfile& profile() { return profile_; }

  /// Adds the weights of a visible point, by lobe group, to its gather point. Call for every visible point,
  /// with or without a path.
  void add_weights(uint32_t gather_point, const Rgb* weights);
  /// Adds a path of a point with these weights. The path brings the light weights[g] * radiance[light] to the
  /// camera, by lobe group g and light. `factor`: the count of points that the path represents.
  void add_path(uint32_t gather_point, const Rgb* weights, float factor, std::span<const Rgb> radiance);
  /// Computes the radiances. Call after all paths were added.
  void finish(const std::vector<uint32_t>& zone_of_gather_point);
  /// Blends the radiances of each patch (see GatherPointKey), after finish(). The fewer paths a gather point
  /// has, the closer its radiance comes to the mean of its patch. The sum of the light that the gather points
  /// of a patch scatter does not change.
  void blend(const std::vector<uint32_t>& patch_of_gather_point, uint32_t patches);
  /// Returns the max memory per gather point, in bytes. At worst, each gather point has a patch of its own.
  static size_t bytes_per_gather_point(size_t lights) {
    return sizeof(Weights) + kLobeGroups * sizeof(Rgb) + 2 * lights * kLobeGroups * sizeof(Rgb);
  }
  /// Returns the result of finish() or blend().
  const Rgb& radiance(uint32_t gather_point, size_t light, int group) const {
    return arrived_[(gather_point * lights_ + light) * kLobeGroups + static_cast<size_t>(group)];
  }

 private:
  struct Weights {
    // Sums over all visible points of the gather point, and over its paths times their factors.
    Rgb all[kLobeGroups] = {Rgb(0), Rgb(0), Rgb(0)};
    Rgb traced[kLobeGroups] = {Rgb(0), Rgb(0), Rgb(0)};
    uint32_t paths = 0;
  };

  size_t lights_ = 0;
  bool guess_ = true;
  DepthProfile profile_;
  std::vector<Weights> weights_;  // by gather point
  std::vector<Rgb> arrived_;  // by gather point, light and lobe group; finish() replaces sums by radiances
  std::vector<Rgb> zone_traced_;   // by zone
  std::vector<Rgb> zone_arrived_;  // by zone and light
  // Sums over the gather points of a patch, each times the part of its radiance that blend() replaces:
  std::vector<Rgb> patch_weights_;    // by patch and lobe group
  std::vector<Rgb> patch_scattered_;  // by patch, light and lobe group
};

}  // namespace pelage
