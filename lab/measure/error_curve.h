// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <utility>
#include <vector>

namespace pelage {

/// Error over CPU time for one way to render: pairs of (CPU seconds, error), one per picture. The pictures
/// differ in the number of samples.
using ErrorCurve = std::vector<std::pair<double, double>>;

/// Returns the CPU seconds after which the error is at most `error`. Interpolates on a straight line between
/// two points, in the logarithms of time and error. Ignores points without a positive time and error. Returns
/// NaN if no two successive points enclose `error`, because it does not extrapolate.
double cpu_s_to(ErrorCurve curve, double error);

/// Returns the error after `cpu_s` CPU seconds, interpolated in the same way. NaN before the first and after
/// the last point.
double error_after(ErrorCurve curve, double cpu_s);

}  // namespace pelage
