// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <vector>

#include "base/vector.h"
#include "render/gather/zones.h"

namespace pelage {

/// Learns from shadow rays which fraction of a light arrives in a zone (see gather_point_keys.h) of a tile,
/// by the direction towards the light. A guess never decides what a picture shows on average: it only makes
/// the estimates of LightSharing less noisy, and helps to choose rays.
class ArrivalGuess {
 public:
  /// Count of ranges of directions: the quarters of the faces of a cube.
  static constexpr uint32_t kRanges = 24;
  /// Returns the range that contains a direction.
  static uint32_t range_of(const V3f& direction);

  /// Sums over some shadow rays.
  struct Sums {
    double seen = 0;     ///< luminance that arrives if nothing blocks the rays
    double arrived = 0;  ///< luminance that arrives
    double rays = 0;

    void add(double luminance, float through) {
      seen += luminance;
      arrived += luminance * through;
      ++rays;
    }
    Sums operator-(const Sums& other) const {
      return {seen - other.seen, arrived - other.arrived, rays - other.rays};
    }
    Sums& operator+=(const Sums& other) {
      seen += other.seen;
      arrived += other.arrived;
      rays += other.rays;
      return *this;
    }
  };

  /// Forgets all rays.
  void begin(size_t lights);
  /// Adds a ray. `luminance`: what arrives along the ray if nothing blocks it.
  void add(uint32_t zone, size_t light, uint32_t range, double luminance, float through);
  /// Updates fraction() and deviation() with the rays added so far. `rejects`: from now on, fraction and
  /// deviation are 0 where all rays of a zone, light and range were blocked. Then no further ray is chosen
  /// there, which loses light ["Rendering Fur in Life of Pi", adaptive importance sampling; Neulander11].
  void learn(bool rejects = false);

  /// Returns the guess of the fraction that arrives, in [0, 1]. 0 before learn().
  float fraction(uint32_t zone, size_t light, uint32_t range) const {
    return at(zone, light, range).fraction;
  }
  /// Returns a guess of the standard deviation of the fraction that one ray transmits; 1 before learn().
  /// Never 0, so that every ray has a chance, unless learn() rejects.
  float deviation(uint32_t zone, size_t light, uint32_t range) const {
    return at(zone, light, range).deviation;
  }
  /// Returns the guess of the fraction from the rays so far, without some rays of the same zone and light.
  /// `of_range`, `of_all`: the sums of those in the same range, and of all.
  float fraction_without(uint32_t zone, size_t light, uint32_t range, const Sums& of_range,
                         const Sums& of_all) const;

  /// Returns the max memory, in bytes.
  static constexpr size_t bytes(size_t lights) {
    return kZonesOfTile * lights * (2 * sizeof(Zone) + kRanges * sizeof(Known));
  }

 private:
  struct Zone {
    Sums all, by_range[kRanges];
  };
  struct Known {
    float fraction = 0, deviation = 1;
  };
  size_t index(uint32_t zone, size_t light) const { return zone % kZonesOfTile * lights_ + light; }
  static float guess(const Sums& of_range, const Sums& of_all);
  static Known known(float fraction);
  Known at(uint32_t zone, size_t light, uint32_t range) const {
    const size_t index = this->index(zone, light) * kRanges + range;
    return index < known_.size() ? known_[index] : other_[light];
  }

  size_t lights_ = 0;
  std::vector<Zone> zones_;   // by zone and light
  std::vector<Known> known_;  // by zone, light and range
  std::vector<Known> other_;  // by light: for zones without a ray
};

}  // namespace pelage
