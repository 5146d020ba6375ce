// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>
#include <vector>

namespace pelage {

/// Estimates how long a job will still take from how far it was when. The first seconds of a render grow fur
/// and read files, so that their rate says little: the rate of the last quarter of the time counts, and it is
/// believed where it does not differ by much from that of the last half.
class TimeLeft {
 public:
  /// `fraction` of the job was done after `elapsed_s`, which never falls. The fraction falls when the job
  /// turns out to be longer.
  void add(double elapsed_s, double fraction);

  /// Seconds from the last add(), or nothing as long as nobody can tell.
  std::optional<double> estimate() const;

 private:
  struct Sample {
    double elapsed_s = 0, fraction = 0;
  };
  /// Progress per second since this share of the time; 0 when that is not known.
  double rate_since(double share) const;

  std::vector<Sample> samples_;  // at growing distances: a few dozen in a week
  Sample last_;
};

}  // namespace pelage
