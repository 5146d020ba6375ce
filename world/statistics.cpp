// SPDX-License-Identifier: Apache-2.0
#include "world/statistics.h"

#include <algorithm>

namespace pelage {

void Statistics::add(const FrameResult& result, double posed_s, double share) {
  frames += result.statistics;
  if (first_pixel_s == 0) first_pixel_s = posed_s + result.first_tile_s;
  samples_per_pixel += result.mean_samples * share;
  noise = std::max(noise, result.noise);
  time_limited |= result.time_limited;
  dual |= result.dual;
  clamped_fraction = std::max(clamped_fraction, result.clamped_fraction);
}

}  // namespace pelage
