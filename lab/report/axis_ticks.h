// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>
#include <vector>

namespace pelage {

/// Round numbers (1, 2 or 5 times a power of ten) within [low, high], about `wanted` of them. Empty unless
/// low < high, both finite.
std::vector<double> linear_ticks(double low, double high, int wanted);

/// The same on a logarithmic axis, 0 < low < high: powers of ten, with 2 and 5 times these where few decades
/// are shown.
std::vector<double> log_ticks(double low, double high);

/// As short as they can be told apart, all with the same decimals where they are evenly spaced.
std::vector<std::string> tick_labels(const std::vector<double>& ticks, bool log);

}  // namespace pelage
