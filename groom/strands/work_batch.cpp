// SPDX-License-Identifier: Apache-2.0
#include "groom/strands/work_batch.h"

#include <array>
#include <utility>

namespace pelage {
namespace {

/// The batches that this thread keeps: one in rest space and one in posed space.
thread_local std::array<std::unique_ptr<StrandBatch>, 2> spare_batches;

}  // namespace

WorkBatch::WorkBatch() {
  for (auto& spare : spare_batches) {
    if (!batch_) batch_ = std::move(spare);
  }
  if (!batch_) {
    batch_ = std::make_unique_for_overwrite<StrandBatch>();
    return;
  }
  batch_->count = 0;
  batch_->skin = nullptr;
  batch_->turns = nullptr;
  batch_->scale = 1;
  batch_->posed = false;
}

WorkBatch::~WorkBatch() {
  const size_t bytes = sizeof(StrandBatch) + batch_->points.capacity() * sizeof(StrandBatch::PointRows) +
                       batch_->colors.capacity() * sizeof(VectorRow);
  if (bytes > kMaxKept) return;
  for (auto& spare : spare_batches) {
    if (spare) continue;
    spare = std::move(batch_);
    return;
  }
}

}  // namespace pelage
