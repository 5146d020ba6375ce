// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "groom/operators/operator.h"
#include "groom/strands/strand_batch.h"

namespace pelage {

/// Turns strand `s` from its root to its tip towards a direction along the skin. Preserves the length of
/// every segment.
///
/// Only the component of `direction` along the skin counts; `direction` is in the batch's space and of any
/// length. Where `direction` is nearly normal to the skin, the strand is raised to the normal instead.
/// `lift`: 0 lies on the skin, 1 stands upright. `amount`: fraction of the way to the target. `curve`:
/// fraction of the strand, from the root, over which it turns.
void comb_strand(StrandBatch& batch, size_t s, const V3f& direction, float lift, float amount, float curve);

/// Returns the bounds of strands after comb_strand() with values of these fields.
StrandReach reach_after_combing(const StrandReach& before, const Field& lift, const Field& amount,
                                float curve);

}  // namespace pelage
