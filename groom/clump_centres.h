// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <functional>

#include "base/ledger.h"
#include "groom/operator.h"
#include "groom/root_grid.h"
#include "groom/strand_batch.h"

namespace pelage {

/// The centre strands of one level of clumps, in rest space.
class ClumpCentres {
 public:
  /// Distributes centres as blue noise, one per spacing^2 of the rest skin; `grow` shapes strands that have
  /// been placed and started. Charged to the ledger. Throws Error: kInput at the operator's position for too
  /// many centres, kMemory before making centres that do not fit, kStopped when the job is stopped.
  ClumpCentres(const PrepareContext& context, float spacing, uint64_t seed,
               const std::function<void(StrandBatch&)>& grow);

  /// Radius within which a strand searches its centre, in spacings. With blue noise, every place has a centre
  /// within this radius.
  static constexpr float kReach = 1.25f;

  const RootGrid& roots() const { return roots_; }
  /// Point of centre `i` at arc length `arc` from its root; extended straight beyond its tip. `segment`:
  /// where the last call for this strand and centre ended (0 at first); arcs must not decrease between calls.
  V3f at(size_t i, float arc, int& segment) const;

 private:
  RootGrid roots_;
  int points_ = 0;
  MemoryCharge charge_;
  std::vector<float> curves_;  // per centre and point: rest position, and arc length up to it
};

}  // namespace pelage
