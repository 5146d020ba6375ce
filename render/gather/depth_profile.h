// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

#include "render/gather/zones.h"

namespace pelage {

/// How the light that arrives changes along the strands of a coat within a tile, from the roots to the tips.
///
/// Visible points that share light share what arrives relative to this profile, and each multiplies it by the
/// value of the profile at its own depth. Otherwise, all points that share would get the light that arrives
/// at the middle of them. Inside a tile, the gather points around a point lie on both sides of it, but at the
/// border of a tile one side is cut off: as strands are darker at their roots, the last row of a tile
/// would be too dark wherever strands hang down, and the first row too bright.
///
/// The profile comes from comparisons among the points of each gather point, which lie on one strand.
/// Comparing the mean light at two depths would not do: roots are seen where a coat is open, and there more
/// light arrives than at the roots of other strands.
///
/// Whatever the values of the profile are, the direct light of all visible points of a gather point keeps its
/// sum (see LightSharing). So does indirect light on average, except that the profile knows the paths of the
/// gather point itself; this changes less than 0.05 % even where three gather points have a tile to
/// themselves.
class DepthProfile {
 public:
  /// Forgets all light. `sources`: count of groups of lights, each with a profile of its own.
  void begin(size_t sources);
  /// Adds a ray or path of a visible point. Those that follow each other with the same gather point and
  /// source are compared with each other. `seen`: luminance that arrives if nothing blocks it, or the weight
  /// of a path. `arrived`: luminance that arrives.
  void add(uint32_t gather_point, const DepthPlace& place, size_t source, double seen, double arrived);
  /// Computes the profile from all light that was added.
  void learn();
  /// Returns what arrives at a place, relative to other depths of the same coat. Positive; 1 before learn().
  float at(const DepthPlace& place, size_t source) const;

  /// Returns the max memory, in bytes, for a count of rays or paths. The factor 2 is for a vector that
  /// doubles its size.
  static constexpr size_t bytes(size_t sources, size_t rays) {
    return kZonesOfTile * sources * (sizeof(Regression) + sizeof(float)) + 2 * rays * sizeof(Arrival);
  }

 private:
  /// A regression of the light that arrives, relative to the mean of a gather point, by depth in zones.
  struct Regression {
    double found = 0, expected = 0;  ///< the slope is found / expected

    Regression& operator+=(const Regression& other) {
      found += other.found;
      expected += other.expected;
      return *this;
    }
  };
  struct Arrival {
    uint32_t gather_point = 0, source = 0;
    float depth = 0;  ///< in zones of the tile
    float seen = 0, arrived = 0;
  };
  void compare(std::span<const Arrival> of_gather_point, std::vector<Regression>& zones) const;
  void integrate(const std::vector<Regression>& zones, size_t source);

  size_t sources_ = 0;
  std::vector<Arrival> arrivals_;
  std::vector<float> logarithm_;  // of the profile at the middle of a zone, by zone and source
};

}  // namespace pelage
