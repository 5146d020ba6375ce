// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <vector>

#include "base/vector.h"
#include "render/film/pixel_filter.h"

namespace pelage {

/// Draws where in and around a pixel a camera ray passes, in proportion to the pixel filter, so that all
/// samples of a pixel weigh the same and pixels stay independent of each other [Ernst06].
class FilterSampler {
 public:
  explicit FilterSampler(PixelFilter filter);

  /// Offset from the centre of the pixel, in pixels, for `u` in [0, 1)^2.
  V2f offset(const V2f& u) const { return {axis(u.x), axis(u.y)}; }

 private:
  float axis(float u) const;

  std::vector<float> inverse_;  // of filter_integral(), at even steps of u; empty for the box
};

}  // namespace pelage
