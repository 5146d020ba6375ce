// SPDX-License-Identifier: Apache-2.0
#include "render/gather/depth_profile.h"

#include <algorithm>
#include <cmath>

namespace pelage {
namespace {

/// The slope of each zone is pulled towards the mean slope, and the mean slope towards 0: each as strongly as
/// by this many average rays that are one zone away from the middle of their gather points.
constexpr double kPriorTraces = 24;
/// Max slope of the logarithm of the profile, per zone.
constexpr double kSteepest = 1.5;

}  // namespace

void DepthProfile::begin(size_t sources) {
  sources_ = sources;
  arrivals_.clear();
  logarithm_.clear();
}

void DepthProfile::add(uint32_t gather_point, const DepthPlace& place, size_t source, double seen,
                       double arrived) {
  arrivals_.push_back({gather_point, static_cast<uint32_t>(source),
                       static_cast<float>(place.zone) + place.toward_next, static_cast<float>(seen),
                       static_cast<float>(arrived)});
}

void DepthProfile::learn() {
  std::vector<Regression> zones(kZonesOfTile * sources_);
  for (auto begin = arrivals_.begin(), end = begin; begin != arrivals_.end(); begin = end) {
    end = std::find_if(begin, arrivals_.end(), [&](const Arrival& other) {
      return other.gather_point != begin->gather_point || other.source != begin->source;
    });
    compare(std::span(begin, end), zones);
  }
  logarithm_.assign(kZonesOfTile * sources_, 0.0f);
  for (size_t source = 0; source < sources_; ++source) integrate(zones, source);
}

/// Adds the rays of a gather point and source to the regression of the zone in which their middle lies.
void DepthProfile::compare(std::span<const Arrival> of_gather_point, std::vector<Regression>& zones) const {
  double seen = 0, arrived = 0, middle = 0;
  for (const Arrival& of : of_gather_point) {
    seen += of.seen;
    arrived += of.arrived;
    middle += double{of.seen} * of.depth;
  }
  if (!(seen > 0)) return;
  middle /= seen;
  const size_t zone = static_cast<size_t>(std::max(middle + 0.5, 0.0)) % kZonesOfTile;
  Regression& to = zones[zone * sources_ + of_gather_point.front().source];
  for (const Arrival& of : of_gather_point) {
    const double offset = of.depth - middle;
    to.found += of.arrived * offset;
    to.expected += arrived / seen * of.seen * offset * offset;
  }
}

/// Computes the profile of a source from the slopes in its zones. Each coat starts at 0: only the depths of
/// one coat are compared, and a sum over many coats would overflow.
void DepthProfile::integrate(const std::vector<Regression>& zones, size_t source) {
  double arrived = 0, count = 0;
  for (const Arrival& of : arrivals_) {
    if (of.source != source) continue;
    arrived += of.arrived;
    ++count;
  }
  if (!(arrived > 0)) return;
  const double prior = kPriorTraces * arrived / count;
  Regression all;
  for (size_t i = source; i < zones.size(); i += sources_) all += zones[i];
  const double mean = all.found / (all.expected + prior);
  double before = 0, sum = 0;
  for (size_t i = source; i < zones.size(); i += sources_) {
    const double slope = (zones[i].found + prior * mean) / (zones[i].expected + prior);
    const double bounded = std::clamp(slope, -kSteepest, kSteepest);
    const bool is_first = i / sources_ % kZonesOfCoat == 0;
    sum = is_first ? 0 : sum + 0.5 * (before + bounded);
    logarithm_[i] = static_cast<float>(sum);
    before = bounded;
  }
}

float DepthProfile::at(const DepthPlace& place, size_t source) const {
  if (logarithm_.empty()) return 1;
  const auto value = [&](size_t zone) { return logarithm_[zone % kZonesOfTile * sources_ + source]; };
  const float here = value(place.zone);
  return std::exp(here + place.toward_next * (value(place.zone + 1) - here));
}

}  // namespace pelage
