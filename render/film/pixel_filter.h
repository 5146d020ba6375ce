// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <vector>

#include "base/value_readers.h"
#include "base/vector.h"

namespace pelage {

enum class PixelFilter { kBox, kBlackmanHarris };
template <>
struct EnumNames<PixelFilter> {
  static constexpr const char* names[] = {"box", "blackman-harris"};
};

/// Returns the half width of a filter, in pixels. Beyond this distance from the centre of the pixel, along
/// either axis, the filter is zero.
float filter_radius(PixelFilter filter);
/// Returns the value of the filter at a distance (in pixels) along one axis, divided by its maximum.
float filter_value(PixelFilter filter, float distance);
/// Returns filter_value() of a sample for the pixel that contains it, and for the pixels before and after it.
/// `from_centre`: position of the sample relative to the centre of its pixel, in pixels, -0.5 to 0.5.
std::array<float, 3> filter_around(PixelFilter filter, float from_centre);
/// Returns the integral of the filter along one axis, from minus filter_radius() to x, divided by the whole
/// integral.
double filter_integral(PixelFilter filter, double x);

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
