// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "base/vector.h"

namespace pelage {

/// Temperatures in kelvin for which black_body_color() is defined.
inline constexpr double kCoolestBlackBody = 1667, kHottestBlackBody = 25000;

/// Returns the linear Rec. 709 colour of a black body, scaled to luminance 1. `kelvin`: clamped to the range
/// above. The chromaticity is a cubic fit to the Planckian locus [Kang02]. Below about
/// 1900 K, the colour is outside Rec. 709; then its blue is 0.
Rgb black_body_color(float kelvin);

}  // namespace pelage
