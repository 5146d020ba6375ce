// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>
#include <vector>

namespace pelage {

/// Estimates the remaining time of a job from its progress.
///
/// The first seconds of a render grow fur and read files, so the progress in this time is not representative.
/// The estimate therefore uses only the rate of progress in the last quarter of the elapsed time. It compares
/// this rate with the rate in the last half of the elapsed time. There is no estimate if one of these rates
/// is more than 1.5 times the other, or if the first rate is not positive. There is also no estimate in the
/// first 3 seconds and before 1 % of the job is done.
class TimeLeft {
 public:
  /// Records that `fraction` of the job (0 to 1) was done `elapsed_s` seconds after its start. `elapsed_s`
  /// must not decrease from call to call. `fraction` may decrease, when the job turns out to be longer than
  /// expected.
  void add(double elapsed_s, double fraction);

  /// Estimated seconds that remain, counted from the time of the last add(). Empty while there is no reliable
  /// estimate.
  std::optional<double> estimate() const;

 private:
  struct Sample {
    double elapsed_s = 0, fraction = 0;
  };
  /// Returns the mean progress per second from the time `share` * elapsed time until the last add(): with a
  /// `share` of 0.75, over the last quarter of the elapsed time. Returns 0 when no sample is that old.
  double rate_since(double share) const;

  std::vector<Sample> samples_;  // at increasing intervals: at most about 260 samples in a week
  Sample last_;
};

}  // namespace pelage
