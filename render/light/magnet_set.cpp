// SPDX-License-Identifier: Apache-2.0
#include "render/light/magnet_set.h"

#include <algorithm>

#include "render/sampling/warp.h"

namespace pelage {

float MagnetSet::wanted(const V3f& from) const {
  float sum = 0;
  for (const Magnet& magnet : magnets_) sum += wanted(magnet, from);
  return sum;
}

float MagnetSet::share(const V3f& from) const { return std::min(wanted(from), 1 - kLeastLobes); }

std::optional<V3f> MagnetSet::sample(const V3f& from, const V3f& u) const {
  float rest = u.z * wanted(from);
  const Magnet* chosen = nullptr;
  for (const Magnet& magnet : magnets_) {
    const float share = wanted(magnet, from);
    if (!(share > 0)) continue;
    chosen = &magnet;  // the last one gets the rounding remainder
    if (rest < share) break;
    rest -= share;
  }
  if (!chosen) return std::nullopt;
  const std::optional<LightSample> sample = chosen->shape->sample(from, {u.x, u.y});
  return sample ? std::optional(sample->direction) : std::nullopt;
}

float MagnetSet::pdf(const V3f& from, const V3f& direction) const {
  float all = 0, sum = 0;
  for (const Magnet& magnet : magnets_) {
    const float share = wanted(magnet, from);
    if (!(share > 0)) continue;
    all += share;
    sum += share * magnet.shape->pdf(from, direction);
  }
  return all > 1 - kLeastLobes ? sum * ((1 - kLeastLobes) / all) : sum;
}

}  // namespace pelage
