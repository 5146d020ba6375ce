// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <functional>

#include "base/ledger.h"
#include "base/parallel.h"
#include "base/progress.h"

namespace pelage {

/// The resources of a long computation: threads, memory ledger, progress. Holds references only and is passed
/// by const reference; all three resources must outlive it.
struct Job {
  const Workers& workers;
  MemoryLedger& ledger;
  Progress& progress;

  /// Throws Error (kStopped) once the user has asked to stop. Call at least every 0.1 s.
  void check_stop() const;

  /// Workers::for_each that throws Error (kStopped) before the next range once the user has asked to stop. A
  /// range should take less than 0.1 s.
  void for_each(size_t count, size_t grain, const std::function<void(WorkRange)>& body) const;
};

}  // namespace pelage
