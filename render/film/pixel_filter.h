// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "base/value_readers.h"

namespace pelage {

enum class PixelFilter { kBox, kBlackmanHarris };
template <>
struct EnumNames<PixelFilter> {
  static constexpr const char* names[] = {"box", "blackman-harris"};
};

/// A filter is zero farther than this from the centre of the pixel, along either axis, in pixels.
float filter_radius(PixelFilter filter);
/// Value of the filter at a distance along one axis, relative to its maximum.
float filter_value(PixelFilter filter, float distance);
/// Integral of the filter along one axis from -radius to x; 1 at x = radius.
double filter_integral(PixelFilter filter, double x);

}  // namespace pelage
