// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "base/vector.h"
#include "render/fibre/fibre_value.h"

namespace pelage {

/// Indirect light that arrives at the points of each knot, estimated from paths of some of the points. For
/// each light and lobe group, it is a mean radiance; a point's indirect light is its weight (rho / pdf) times
/// this radiance.
///
/// The estimate is the same as in LightSharing, but the weights of all points of a knot replace the
/// unoccluded light, and radiance replaces the fraction that arrives.
class PathSharing {
 public:
  void begin(size_t knots, uint32_t zones, size_t lights, bool guess);

  void add_weights(uint32_t knot, const Rgb* weights);
  /// Adds a path that represents `factor` points. It brings weights[g] * radiance[light] to the camera.
  void add_path(uint32_t knot, const Rgb* weights, float factor, std::span<const Rgb> radiance);
  void finish(const std::vector<uint32_t>& zone_of_knot);
  static size_t bytes_per_knot(size_t lights) { return sizeof(Weights) + lights * kLobeGroups * sizeof(Rgb); }
  const Rgb& radiance(uint32_t knot, size_t light, int group) const {
    return arrived_[(knot * lights_ + light) * kLobeGroups + static_cast<size_t>(group)];
  }

 private:
  struct Weights {
    Rgb all[kLobeGroups] = {Rgb(0), Rgb(0), Rgb(0)};
    Rgb traced[kLobeGroups] = {Rgb(0), Rgb(0), Rgb(0)};
  };

  size_t lights_ = 0;
  bool guess_ = true;
  std::vector<Weights> weights_;   // by knot
  std::vector<Rgb> arrived_;       // by knot, light and group
  std::vector<Rgb> zone_traced_;   // by zone
  std::vector<Rgb> zone_arrived_;  // by zone and light
};

}  // namespace pelage
