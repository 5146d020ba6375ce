// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <vector>

#include "base/vector.h"
#include "groom/follicles/follicle_candidates.h"

namespace pelage {

/// The radii of progressive dart throwing (progressive_order.h), by level.
class DartRadii {
 public:
  /// Ratio of the radii of consecutive levels: small steps keep prefixes that end within a level nearly
  /// optimal.
  static constexpr double kShrink = 0.94;
  /// Down to a radius of 1e-11 of the first: only coincident candidates remain.
  static constexpr int kLevels = 400;

  explicit DartRadii(double area)
      : area_(area), largest_(std::sqrt(kExpectedFill * area * 2.0 / std::sqrt(3.0))) {
    for (int level = 0; level <= kLevels; ++level) rounded_[level] = static_cast<float>(at(level));
  }

  double at(int level) const { return level < kLevels ? largest_ * std::pow(kShrink, level) : 0.0; }
  /// First level at which a candidate at `distance` from the nearest follicle is not too close to it. Exact
  /// for radii rounded to float, with which distances are compared: all methods must try it at the same
  /// level.
  int level_of(float distance) const {
    if (!(distance > 0)) return kLevels;
    const double guess = std::ceil(std::log(distance / largest_) * (1.0 / std::log(kShrink)));
    auto level = static_cast<int>(std::clamp(guess, 0.0, double{kLevels}));
    while (level > 0 && distance >= rounded_[level - 1]) --level;
    while (level < kLevels && distance < rounded_[level]) ++level;
    return level;
  }
  /// Expected number of follicles: hexagonal packing has 2 / (sqrt(3) r^2) points at distance r per unit
  /// area.
  double expected(double radius) const {
    return kExpectedFill * area_ * 2.0 / (std::sqrt(3.0) * radius * radius);
  }
  /// The level at which `count` follicles are found on a skin that is much wider than their distance.
  int last_level(size_t count) const {
    return level_of(static_cast<float>(std::sqrt(kFill * expected(1.0) / static_cast<double>(count))));
  }
  /// Returns how many candidates, in the order of their ranks, are tried at this radius; at most `all`.
  double joining(double radius, size_t all) const {
    return std::min(kTakePart * expected(radius) + 1, static_cast<double>(all));
  }

 private:
  /// Fraction of the densest (hexagonal) packing that dart throwing is expected to reach.
  static constexpr double kExpectedFill = 0.5;
  /// Min fraction of the expected number of follicles that is found, except at a few levels.
  static constexpr double kFill = 0.5;
  /// Active candidates per expected follicle: a fifth more than the final number per follicle.
  static constexpr double kTakePart = 1.2 * static_cast<double>(kCandidatesPerFollicle);

  double area_;
  double largest_;  // for one expected follicle
  std::array<float, kLevels + 1> rounded_;
};

/// Spreads the lower 10 bits of a coordinate, clamped to 0 .. 1023, so that two bits are between neighbours.
inline uint32_t spread_coordinate(float coordinate) {
  auto x = static_cast<uint32_t>(std::clamp(coordinate, 0.0f, 1023.0f));
  x = (x | x << 16) & 0x030000ff;
  x = (x | x << 8) & 0x0300f00f;
  x = (x | x << 4) & 0x030c30c3;
  return (x | x << 2) & 0x09249249;
}

/// The regions of space in which candidates of one level are tried together: Morton codes of cubic cells.
class DartRegions {
 public:
  /// Cells with side 1 / `inverse`.
  DartRegions(const V3f& origin, float inverse) : origin_(origin), inverse_(inverse) {}
  /// The regions of a level. They contain some thousand follicles, so that those examined together stay in
  /// the cache.
  static DartRegions of_level(const CandidateSurvey& survey, double radius) {
    const float side = 64.0f * static_cast<float>(radius) * survey.smallest_spacing;
    return {survey.box.min, std::min(1.0f / side, finest(survey).inverse_)};
  }
  /// The finest regions for which the code has room.
  static DartRegions finest(const CandidateSurvey& survey) {
    const V3f size = survey.box.size();
    return {survey.box.min, 1023.0f / std::max({size.x, size.y, size.z, 1e-30f})};
  }

  uint32_t operator()(const FollicleCandidate& c) const {
    return spread_coordinate((c.x - origin_.x) * inverse_) |
           spread_coordinate((c.y - origin_.y) * inverse_) << 1 |
           spread_coordinate((c.z - origin_.z) * inverse_) << 2;
  }

 private:
  V3f origin_;
  float inverse_;
};

/// A follicle that was found at the current level.
struct AcceptedDart {
  uint32_t rank, attempt;
};

/// Appends the attempts of the follicles of a level to the progressive order, and clears `accepted`. Orders
/// them at random: their order must not depend on their positions.
void append_at_random(const Job& job, std::vector<AcceptedDart>& accepted, std::vector<uint32_t>& order);

/// Room for the surplus of the last level, which is removed again.
inline size_t with_overshoot(size_t count) { return count + count / 6; }

}  // namespace pelage
