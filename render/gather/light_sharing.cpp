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

void LightSharing::add_unoccluded(uint32_t knot, size_t light, const Rgb* lobes) {
  Knot& at = grown(knots_, knot * lights_ + light);
  for (size_t g = 0; g < kLobeGroups; ++g) at.unoccluded[g] += lobes[g];
}

void LightSharing::add_ray(uint32_t knot, uint32_t zone, size_t light, const Rgb* lobes, float factor,
                           float through) {
  Knot& at = grown(knots_, knot * lights_ + light);
  Zone& all = grown(zones_, zone * lights_ + light);
  for (size_t g = 0; g < kLobeGroups; ++g) {
    const Rgb seen = lobes[g] * factor;
    at.seen[g] += seen;
    at.arrived[g] += seen * through;
    all.seen += luminance(seen);
    all.arrived += luminance(seen) * through;
  }
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

/// Fraction that arrives at the knots of a zone except `own`; 0 if they have no rays.
float LightSharing::guess_of_others(const Zone& zone, const Knot& own) {
  double seen = zone.seen, arrived = zone.arrived;
  for (size_t g = 0; g < kLobeGroups; ++g) {
    seen -= luminance(own.seen[g]);
    arrived -= luminance(own.arrived[g]);
  }
  return seen > 1e-6 * zone.seen ? static_cast<float>(arrived / seen) : 0.0f;
}

void LightSharing::finish(const std::vector<uint32_t>& zone_of_knot) {
  knots_.resize(zone_of_knot.size() * lights_);
  for (size_t knot = 0; knot < zone_of_knot.size(); ++knot) {
    for (size_t light = 0; light < lights_; ++light) {
      Knot& own = knots_[knot * lights_ + light];
      const size_t index = zone_of_knot[knot] * lights_ + light;
      const float guess = guess_ && index < zones_.size() ? guess_of_others(zones_[index], own) : 0.0f;
      for (size_t g = 0; g < kLobeGroups; ++g) {
        const Rgb correction = own.arrived[g] - guess * own.seen[g];
        for (int c = 0; c < 3; ++c) {
          const float all = own.unoccluded[g][c];
          own.arrived[g][c] = all > 0 ? guess + correction[c] / all : 0.0f;
        }
      }
    }
  }
}

}  // namespace pelage
