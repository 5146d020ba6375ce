// SPDX-License-Identifier: Apache-2.0
#include "render/gather/light_sharing.h"

#include <algorithm>

namespace pelage {
namespace {

template <class T>
T& grown(std::vector<T>& items, size_t index) {
  if (index >= items.size()) items.resize(std::max(index + 1, 2 * items.size()));
  return items[index];
}

}  // namespace

void LightSharing::begin(size_t lights, bool guess) {
  lights_ = lights;
  guess_ = guess;
  knots_.clear();
  zones_.clear();
}

void LightSharing::add_unoccluded(uint32_t knot, size_t light, float luminance) {
  grown(knots_, knot * lights_ + light).unoccluded += luminance;
}

void LightSharing::add_ray(uint32_t knot, uint32_t zone, size_t light, float luminance, float through) {
  Knot& at = grown(knots_, knot * lights_ + light);
  at.seen += luminance;
  at.arrived += through * luminance;
  Zone& all = grown(zones_, zone * lights_ + light);
  all.seen += luminance;
  all.arrived += through * luminance;
  ++all.rays;
}

float LightSharing::chance(uint32_t zone, size_t light) const {
  const size_t index = zone * lights_ + light;
  if (index >= zones_.size() || zones_[index].rays == 0) return 1;
  // As if one ray more had arrived.
  const Zone& of = zones_[index];
  const auto mean = static_cast<float>(of.arrived / of.seen), rays = static_cast<float>(of.rays);
  return std::max(kMinChance, (mean * rays + 1) / (rays + 1));
}

void LightSharing::finish(const std::vector<uint32_t>& zone_of_knot) {
  knots_.resize(zone_of_knot.size() * lights_);
  for (size_t knot = 0; knot < zone_of_knot.size(); ++knot) {
    for (size_t light = 0; light < lights_; ++light) {
      Knot& own = knots_[knot * lights_ + light];
      if (!(own.unoccluded > 0)) continue;
      double guess = 0;
      const size_t index = zone_of_knot[knot] * lights_ + light;
      if (guess_ && index < zones_.size()) {
        const Zone& zone = zones_[index];
        const double others = zone.seen - own.seen;
        if (others > 1e-6 * zone.seen) guess = (zone.arrived - own.arrived) / others;
      }
      own.fraction = static_cast<float>(guess + (own.arrived - guess * own.seen) / own.unoccluded);
    }
  }
}

}  // namespace pelage
