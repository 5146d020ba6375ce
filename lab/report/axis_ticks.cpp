// SPDX-License-Identifier: Apache-2.0
#include "lab/report/axis_ticks.h"

#include <algorithm>
#include <cmath>

#include <fmt/format.h>

#include "lab/report/quantity.h"

namespace pelage {
namespace {

double nice_step(double raw) {
  const double power = std::pow(10.0, std::floor(std::log10(raw)));
  const double lead = raw / power;
  return (lead < 1.5 ? 1 : lead < 3.5 ? 2 : lead < 7.5 ? 5 : 10) * power;
}

}  // namespace

std::vector<double> linear_ticks(double low, double high, int wanted) {
  std::vector<double> ticks;
  if (!std::isfinite(low) || !std::isfinite(high) || !(low < high) || wanted < 1) return ticks;
  const double step = nice_step((high - low) / wanted);
  const double first = std::ceil(low / step - 1e-9), last = std::floor(high / step + 1e-9);
  for (double i = first; i <= last; ++i) ticks.push_back(i * step + 0.0);
  return ticks;
}

std::vector<double> log_ticks(double low, double high) {
  std::vector<double> ticks;
  if (!std::isfinite(low) || !std::isfinite(high) || !(low > 0) || !(low < high)) return ticks;
  const bool fine = high / low < 2000;
  for (double e = std::floor(std::log10(low)); e <= std::ceil(std::log10(high)); ++e) {
    for (const double lead : {1.0, 2.0, 5.0}) {
      if (lead > 1 && !fine) continue;
      const double tick = lead * std::pow(10.0, e);
      if (tick >= low * (1 - 1e-9) && tick <= high * (1 + 1e-9)) ticks.push_back(tick);
    }
  }
  return ticks;
}

std::vector<std::string> tick_labels(const std::vector<double>& ticks, bool log) {
  std::vector<std::string> labels;
  // Ticks have one significant digit; for evenly spaced ones the step determines the decimals.
  const auto decimals_of = [](double number) {
    return number == 0
               ? 0
               : std::clamp(static_cast<int>(-std::floor(std::log10(std::abs(number)) + 1e-9)), 0, 12);
  };
  const double step = ticks.size() > 1 ? ticks[1] - ticks[0] : 0;
  for (const double tick : ticks)
    labels.push_back(number_text(tick, {1, "", decimals_of(log || ticks.size() < 2 ? tick : step)}));
  return labels;
}

}  // namespace pelage
