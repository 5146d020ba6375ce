// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <memory>

#include "groom/strands/strand_batch.h"

namespace pelage {

/// A batch for one growth of strands. It reuses the memory of an earlier batch of the same thread: a crowd
/// grows leaves of a few strands thousands of times, and returning some hundred KB to the system each time
/// took longer than growing the strands.
///
/// The contents of its rows are unspecified, also those of strands beyond `count`. Everything else is as in a
/// new batch, except that `points` and `colors` may have any size.
///
/// Each thread keeps at most two batches of at most kMaxKept bytes each. No ledger is charged for them, as
/// for the stack of the thread; while they are in use, the memory reserved for growth covers them.
class WorkBatch {
 public:
  static constexpr size_t kMaxKept = size_t(256) << 10;

  WorkBatch();
  ~WorkBatch();
  WorkBatch(const WorkBatch&) = delete;
  WorkBatch& operator=(const WorkBatch&) = delete;

  StrandBatch& operator*() const { return *batch_; }
  StrandBatch* operator->() const { return batch_.get(); }

 private:
  std::unique_ptr<StrandBatch> batch_;
};

}  // namespace pelage
