// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <vector>

#include "base/vector.h"
#include "render/film/film_layers.h"

namespace pelage {

/// Samples the position of a camera ray in and around a pixel in proportion to the pixel filter, so that all
/// samples of a pixel have the same weight and pixels stay independent [Ernst06].
class FilterSampler {
 public:
  explicit FilterSampler(PixelFilter filter);

  /// Offset from the centre of the pixel, in pixels, for `u` in [0, 1)^2.
  V2f offset(const V2f& u) const { return {axis(u.x), axis(u.y)}; }
  /// The filter is zero beyond this distance from the centre, along either axis.
  float radius() const { return radius_; }
  /// Integral of the filter along one axis from -radius to x, normalised to 1.
  double cumulative(double x) const;

 private:
  float axis(float u) const;

  PixelFilter filter_;
  float radius_;
  std::vector<float> inverse_;  // inverse of cumulative(), at evenly spaced u; empty for the box filter
};

}  // namespace pelage
