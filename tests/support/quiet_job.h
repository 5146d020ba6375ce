// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <memory>

#include "base/job.h"

namespace pelage {

/// A job that shows nothing and is never stopped, for calls and tests that need no more.
class QuietJob {
 public:
  explicit QuietJob(int threads = 2)
      : workers_(threads), own_(std::make_unique<MemoryLedger>()), ledger_(*own_) {}
  QuietJob(int threads, MemoryLedger& ledger) : workers_(threads), ledger_(ledger) {}
  QuietJob(Workers workers, MemoryLedger& ledger) : workers_(std::move(workers)), ledger_(ledger) {}

  operator Job() { return {workers_, ledger_, progress_}; }
  MemoryLedger& ledger() { return ledger_; }
  const Workers& workers() const { return workers_; }

 private:
  Workers workers_;
  std::unique_ptr<MemoryLedger> own_;
  MemoryLedger& ledger_;
  NoProgress progress_;
};

}  // namespace pelage
