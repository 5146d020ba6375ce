// SPDX-License-Identifier: Apache-2.0
#include "cli/time_left.h"

#include <algorithm>

namespace pelage {
namespace {

constexpr double kFirst_s = 3;
constexpr double kMinDone = 0.01;
/// Max ratio of the rates of the last quarter and of the last half. Just after a slow start they differ by a
/// factor of two.
constexpr double kAgreement = 1.5;

/// Interval of stored samples, such that one is near any fraction of the time.
double next_sample(double elapsed_s) { return 1.05 * elapsed_s + 0.1; }

}  // namespace

void TimeLeft::add(double elapsed_s, double fraction) {
  last_ = {elapsed_s, fraction};
  if (samples_.empty() || elapsed_s >= next_sample(samples_.back().elapsed_s)) samples_.push_back(last_);
}

double TimeLeft::rate_since(double share) const {
  const auto after = std::upper_bound(samples_.begin(), samples_.end(), last_.elapsed_s * share,
                                      [](double t, const Sample& s) { return t < s.elapsed_s; });
  if (after == samples_.begin()) return 0;
  const Sample& from = *(after - 1);
  return (last_.fraction - from.fraction) / (last_.elapsed_s - from.elapsed_s);
}

std::optional<double> TimeLeft::estimate() const {
  if (last_.elapsed_s < kFirst_s || last_.fraction < kMinDone) return {};
  const double of_quarter = rate_since(0.75), of_half = rate_since(0.5);
  if (!(of_quarter > 0) || of_quarter > kAgreement * of_half || of_half > kAgreement * of_quarter) return {};
  return std::max(0.0, 1 - last_.fraction) / of_quarter;
}

}  // namespace pelage
