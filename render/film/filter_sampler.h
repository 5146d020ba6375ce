// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <vector>

#include "base/vector.h"
#include "render/film/pixel_filter.h"

namespace pelage {

/// Samples the position of a camera ray in or around a pixel, with a density proportional to the pixel filter
/// [Ernst06]. All samples of a pixel then have the same weight, and each sample counts for one pixel only.
class FilterSampler {
 public:
  explicit FilterSampler(PixelFilter filter);

  /// Returns the offset from the centre of the pixel, in pixels. `u`: two random numbers in [0, 1).
  V2f offset(const V2f& u) const { return {axis(u.x), axis(u.y)}; }

 private:
  float axis(float u) const;

  std::vector<float> inverse_;  // inverse of filter_integral() at equal steps of u; empty for the box filter
};

}  // namespace pelage
