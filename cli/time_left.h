// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>
#include <vector>

namespace pelage {

/// Estimates the remaining time of a job from its progress. The first seconds of a render grow fur and read
/// files, so their rate is not representative: the estimate uses the rate of the last quarter of the time, if
/// it does not differ much from the rate of the last half.
class TimeLeft {
 public:
  /// `fraction` of the job was done after `elapsed_s`, which must not decrease. The fraction decreases when
  /// the job turns out to be longer.
  void add(double elapsed_s, double fraction);

  /// Seconds from the last add(), or empty while there is no reliable estimate.
  std::optional<double> estimate() const;

 private:
  struct Sample {
    double elapsed_s = 0, fraction = 0;
  };
  /// Progress per second since this fraction of the time; 0 when unknown.
  double rate_since(double share) const;

  std::vector<Sample> samples_;  // at increasing intervals: a few dozen in a week
  Sample last_;
};

}  // namespace pelage
