// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <utility>
#include <vector>

namespace pelage {

/// CPU seconds and error of pictures rendered in one way, with different numbers of samples.
using ErrorCurve = std::vector<std::pair<double, double>>;

/// CPU seconds after which the error is at most `error`: interpolated on a straight line between two points,
/// in logarithms of both. NaN where the points do not enclose `error`, because nothing is extrapolated.
/// Points without a positive error are left out.
double cpu_s_to(ErrorCurve curve, double error);

}  // namespace pelage
