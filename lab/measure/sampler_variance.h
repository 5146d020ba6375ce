// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "lab/report/report.h"
#include "render/fibre/cone_shell.h"

namespace pelage {

/// Relative variance of the light that one fibre scatters to the viewer, per traced ray: variance / mean^2 *
/// rays per estimate. NaN where a technique cannot find the light.
struct TechniqueVariance {
  double light = 0;             ///< one point on the light
  double shell[3] = {0, 0, 0};  ///< one direction from the shell, by ShellSampler
  double both[3] = {0, 0, 0};   ///< both, by the power heuristic: two rays
  double mean = 0;              ///< light scattered by a light of radiance 1
};

/// Returns the variances for a shell of the Wigner variant about a fibre seen at `theta_o` (radians), under
/// an even light that fills a cone of half angle `light` (radians) about the mirror direction; pi is an even
/// sky. `samples`: count of samples of each technique, from fixed random numbers.
TechniqueVariance technique_variance(const ShellShape& shape, float theta_o, float light, int samples);

/// Returns a table of technique_variance() for shells and lights of several widths.
Table integrand_variances();

}  // namespace pelage
