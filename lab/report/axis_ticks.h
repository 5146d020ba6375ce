// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>
#include <vector>

namespace pelage {

/// About `wanted` round numbers (1, 2 or 5 times a power of ten) within [low, high]. Empty unless low < high,
/// both finite.
std::vector<double> linear_ticks(double low, double high, int wanted);

/// The same on a logarithmic axis, 0 < low < high: powers of ten, also multiplied by 2 and 5 for few decades.
std::vector<double> log_ticks(double low, double high);

/// The shortest labels that distinguish the ticks, with equal decimals for evenly spaced ones.
std::vector<std::string> tick_labels(const std::vector<double>& ticks, bool log);

}  // namespace pelage
