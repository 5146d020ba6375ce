// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <cstdint>

namespace pelage {

/// A planar Bezier curve in ray space; the ray passes through the origin.
struct PlaneCurve {
  float x[4], y[4];
  float dx[3], dy[3];  ///< differences of consecutive points, more accurate than the points
  float end_x, end_y;  ///< the last point, rounded like the first one of the next curve
};

/// The parameters in (0, 1] where the curve's distance to the origin has a local minimum: at most three,
/// ascending.
///
/// The derivative of half the squared distance, c . c', is a quintic. The number of sign changes of its
/// Bernstein coefficients is at least the number of its roots. Where there is more than one sign change, the
/// curve is halved repeatedly ([Nakamaru02] halves until the curve is straight, which finds the same minima
/// up to its tolerance).
size_t nearest_parameters(const PlaneCurve& curve, float (&out)[3]);

}  // namespace pelage
