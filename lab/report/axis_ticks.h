// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>
#include <vector>

namespace pelage {

/// Returns about `wanted` round numbers (1, 2 or 5 times a power of ten) within [low, high]. Empty unless low
/// < high and both are finite.
std::vector<double> linear_ticks(double low, double high, int wanted);

/// Returns ticks for a logarithmic axis from `low` to `high`: powers of ten and, if the axis spans only a few
/// decades, also 2 and 5 times these. Empty unless 0 < low < high and both are finite.
std::vector<double> log_ticks(double low, double high);

/// Returns the shortest labels that distinguish the ticks. On a linear axis, all labels have the same number
/// of decimals.
std::vector<std::string> tick_labels(const std::vector<double>& ticks, bool log);

}  // namespace pelage
