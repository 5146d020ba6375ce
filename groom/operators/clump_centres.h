// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <functional>

#include "base/ledger.h"
#include "groom/operators/operator.h"
#include "groom/strands/root_grid.h"
#include "groom/strands/strand_batch.h"

namespace pelage {

/// The centre strands of one level of clumps, in rest space.
class ClumpCentres {
 public:
  /// Distributes the roots of centre strands as blue noise, one per spacing^2 of the area of the rest skin.
  /// Calls `grow` to shape the centre strands, which start straight at these roots. Charges the memory to the
  /// ledger. Throws Error: kInput, with the operator's position, for too many centres; kMemory before making
  /// centres that do not fit; kStopped when the job is stopped.
  ClumpCentres(const PrepareContext& context, float spacing, uint64_t seed,
               const std::function<void(StrandBatch&)>& grow);

  /// Radius within which a strand searches its centre, as a multiple of the spacing. With blue noise, every
  /// point of the skin has a centre within this radius.
  static constexpr float kReach = 1.25f;

  const RootGrid& roots() const { return roots_; }
  int points() const { return points_; }  ///< of each centre strand
  /// Returns point `p` of centre strand `i`.
  V3f point(size_t i, int p) const {
    const float* at = place(i, p);
    return {at[0], at[1], at[2]};
  }
  /// Returns the arc length from the root of centre strand `i` to its point `p`.
  float arc(size_t i, int p) const { return place(i, p)[3]; }
  /// Returns the point of centre strand `i` at arc length `arc` from its root. Beyond the tip, the strand is
  /// extended straight. `segment` is both input and output: the segment where the last call for this strand
  /// and centre ended, 0 for the first call. `arc` must not decrease between these calls.
  V3f at(size_t i, float arc, int& segment) const;

 private:
  const float* place(size_t i, int p) const {
    return &curves_[(i * static_cast<size_t>(points_) + static_cast<size_t>(p)) * 4];
  }

  RootGrid roots_;
  int points_ = 0;
  MemoryCharge charge_;
  std::vector<float> curves_;  // per centre and point: rest position, and arc length from the root to it
};

}  // namespace pelage
