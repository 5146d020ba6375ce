// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <functional>

#include "base/ledger.h"
#include "base/parallel.h"
#include "base/progress.h"

namespace pelage {

/// The resources of a long computation: threads, memory ledger, progress. A Job only refers to these
/// resources, which must outlive the Job. Functions take a Job by const reference.
struct Job {
  const Workers& workers;
  MemoryLedger& ledger;
  Progress& progress;

  /// Throws Error (kStopped) if the user has asked to stop. Long loops must call it at least every 0.1 s.
  void check_stop() const;

  /// Runs Workers::for_each(), and calls check_stop() before each range. Therefore throws Error (kStopped)
  /// once the user has asked to stop. A range should take less than 0.1 s.
  void for_each(size_t count, size_t grain, const std::function<void(WorkRange)>& body) const;
};

}  // namespace pelage
