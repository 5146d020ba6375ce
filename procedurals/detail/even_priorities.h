// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <vector>

#include "base/ledger.h"
#include "groom/groom.h"

namespace pelage {

/// Evenly spread priorities for the strands of a groom whose own priorities are independent random numbers
/// (Groom::has_priority_order()). The priority of a strand, in [0, 1), is the radical inverse of its rank
/// along a curve through the roots. So strands with priorities below 2^-n are every 2^n-th strand along the
/// curve, and each clump keeps the same fraction of its strands.
///
/// The curve is a Z curve within each face of the skin, and passes the faces in their order. Without a skin,
/// it is a Z curve through space. The result depends only on the roots at rest and the ids of the strands,
/// not on leaves. Immutable; thread safe.
class EvenPriorities {
 public:
  /// Charges its memory to MemoryTag::kGrooms. Throws Error (kMemory) if it does not fit.
  EvenPriorities(const Groom& groom, MemoryLedger& ledger);

  float operator[](size_t follicle) const { return of_follicle_[follicle]; }
  size_t size() const { return of_follicle_.size(); }

 private:
  std::vector<float> of_follicle_;
  MemoryCharge charge_;
};

}  // namespace pelage
