// SPDX-License-Identifier: Apache-2.0
#include "render/gather/arrival_guess.h"

#include <algorithm>
#include <cmath>

namespace pelage {
namespace {

/// The rays of a zone in all directions count as much as this many rays of one range.
constexpr double kPriorRays = 2;
/// Least variance of the fraction that a ray transmits: guesses near 0 and 1 are uncertain.
constexpr float kLeastVariance = 0.02f;

}  // namespace

uint32_t ArrivalGuess::range_of(const V3f& direction) {
  uint32_t axis = 0;
  for (uint32_t i = 1; i < 3; ++i) {
    if (std::abs(direction[static_cast<int>(i)]) > std::abs(direction[static_cast<int>(axis)])) axis = i;
  }
  uint32_t range = axis;
  for (int i = 0; i < 3; ++i) range = 2 * range + (direction[i] < 0 ? 1 : 0);
  return range;
}

void ArrivalGuess::begin(size_t lights) {
  lights_ = lights;
  zones_.clear();
  known_.clear();
  other_.assign(lights, {});
}

void ArrivalGuess::add(uint32_t zone, size_t light, uint32_t range, double luminance, float through) {
  const size_t at = index(zone, light);
  if (at >= zones_.size()) zones_.resize((zone % kZonesOfTile + 1) * lights_);
  zones_[at].all.add(luminance, through);
  zones_[at].by_range[range].add(luminance, through);
}

float ArrivalGuess::guess(const Sums& of_range, const Sums& of_all) {
  // Differences of sums may leave rounding errors where no ray is left.
  if (of_all.rays < 0.5 || !(of_all.seen > 0)) return 0;
  const double all = std::clamp(of_all.arrived / of_all.seen, 0.0, 1.0);
  if (of_range.rays < 0.5 || !(of_range.seen > 0)) return static_cast<float>(all);
  const double prior = kPriorRays * of_all.seen / of_all.rays;
  const double arrived = std::max(of_range.arrived, 0.0) + prior * all;
  return static_cast<float>(std::min(arrived / (of_range.seen + prior), 1.0));
}

ArrivalGuess::Known ArrivalGuess::known(float fraction) {
  return {fraction, std::sqrt(std::max(kLeastVariance, fraction * (1 - fraction)))};
}

void ArrivalGuess::learn(bool rejects) {
  known_.resize(zones_.size() * kRanges);
  std::vector<Sums> all(lights_);
  for (size_t i = 0; i < zones_.size(); ++i) {
    const Zone& zone = zones_[i];
    for (size_t range = 0; range < kRanges; ++range) {
      const Sums& of_range = zone.by_range[range];
      const bool rejected = rejects && of_range.rays > 0 && !(of_range.arrived > 0);
      known_[i * kRanges + range] = rejected ? Known{0, 0} : known(guess(of_range, zone.all));
    }
    all[i % lights_] += zone.all;
  }
  for (size_t light = 0; light < lights_; ++light) {
    if (all[light].rays > 0) other_[light] = known(guess({}, all[light]));
  }
}

float ArrivalGuess::fraction_without(uint32_t zone, size_t light, uint32_t range, const Sums& of_range,
                                     const Sums& of_all) const {
  const size_t at = index(zone, light);
  if (at >= zones_.size()) return 0;
  return guess(zones_[at].by_range[range] - of_range, zones_[at].all - of_all);
}

}  // namespace pelage
