// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <vector>

#include "base/vector.h"
#include "render/film/pixel_filter.h"

namespace pelage {

/// Samples the position of a camera ray in and around a pixel in proportion to the pixel filter, so that all
/// samples of a pixel have the same weight and pixels stay independent [Ernst06].
class FilterSampler {
 public:
  explicit FilterSampler(PixelFilter filter);

  /// Offset from the centre of the pixel, in pixels, for `u` in [0, 1)^2.
  V2f offset(const V2f& u) const { return {axis(u.x), axis(u.y)}; }

 private:
  float axis(float u) const;

  std::vector<float> inverse_;  // inverse of filter_integral(), at even steps of u; empty for the box
};

}  // namespace pelage
