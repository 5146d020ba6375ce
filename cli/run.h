// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string_view>

#include "base/job.h"
#include "base/ledger.h"
#include "base/memory_sampler.h"
#include "base/parallel.h"
#include "cli/progress_display.h"
#include "cli/run_options.h"
#include "cli/signals.h"
#include "world/statistics.h"

namespace pelage {

/// Context of a long-running command: threads, memory ledger, statistics, progress display and clock.
class Run {
 public:
  explicit Run(const RunOptions& options);

  Workers& workers() { return workers_; }
  MemoryLedger& ledger() { return ledger_; }
  Statistics& statistics() { return statistics_; }
  ProgressDisplay& display() { return display_; }
  Job job() { return {workers_, ledger_, display_}; }
  /// Wall time in seconds since the start of the run.
  double seconds() const;

  /// Runs `work` as a stage without intermediate progress. Adds its wall time to the statistic stages_s.
  template <class Work>
  auto stage(std::string_view name, Work&& work) {
    const StageTimer timer(*this, name);
    return work();
  }

  /// Completes the statistics and writes them to the file of `--stats`, if this flag is given.
  void finish(const RunOptions& options);

 private:
  class StageTimer {
   public:
    StageTimer(Run& run, std::string_view name);
    ~StageTimer();

   private:
    Run& run_;
    std::string name_;
    double began_;
    int exceptions_;
  };

  MemorySampler::Clock::time_point start_ = MemorySampler::Clock::now();
  SignalGuard signals_;
  MemoryLedger ledger_;
  Statistics statistics_;
  bool keeps_timeline_;
  MemorySampler sampler_;
  Workers workers_;
  ProgressDisplay display_;
};

}  // namespace pelage
