// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>

namespace pelage {

/// Returns the value for a screen, in [0, 1], of a linear value of one colour channel. First applies the fit
/// of Narkowicz to the ACES reference transform, x (2.51 x + 0.03) / (x (2.43 x + 0.59) + 0.14), after an
/// exposure of 0.72 that leaves middle grey (0.18) where it is. Then applies the sRGB transfer curve.
/// Negative values and NaN become 0. tools/exr_to_png and view/page/picture.js compute the same.
float view_transform(float linear);

/// Returns view_transform() as a byte, rounded to nearest.
uint8_t view_byte(float linear);

}  // namespace pelage
