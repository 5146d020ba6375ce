// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>

#include "base/value_readers.h"

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

}  // namespace pelage
