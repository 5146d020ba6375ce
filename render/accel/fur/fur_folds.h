// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <cstdint>

namespace pelage {

/// A cubic Bezier curve in the x-y plane of ray space (see FurRay). The ray passes through the origin.
struct PlaneCurve {
  float x[4], y[4];
  float dx[3], dy[3];  ///< differences of consecutive points, more accurate than the points
  float end_x, end_y;  ///< the last point, rounded as the first point of the next curve is
};

/// Finds the parameters in (0, 1] where the curve's distance to the origin has a local minimum. Writes them
/// to `out` in ascending order and returns their count, which is at most 3.
///
/// Method: the derivative of half the squared distance, c . c', is a quintic polynomial. It has at most as
/// many roots as its Bernstein coefficients have sign changes. A part of the curve with more than one sign
/// change is halved, and so on. [Nakamaru02] instead halves until the parts are straight. This finds the same
/// minima, up to its tolerance.
size_t nearest_parameters(const PlaneCurve& curve, float (&out)[3]);

}  // namespace pelage
